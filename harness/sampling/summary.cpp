#include "harness/sampling/summary.h"

#include <fmt/format.h>

#include <stdexcept>

#include "harness/base/work.h"

namespace assay::harness {
namespace {

void merge(ChannelDetails& ours, const ChannelDetails& theirs) {
  ours.histogram.merge(theirs.histogram);
  for (std::size_t cell = 0; cell < ours.cells.size(); ++cell) {
    ours.cells[cell] += theirs.cells[cell];
  }
  for (std::size_t k = 0; k < ours.joint.size(); ++k) ours.joint[k].merge(theirs.joint[k]);
}

std::string refusal(const std::string& name, double spread, const char* power) {
  return fmt::format(
      "the observations of `{}` spread over {:.3g}, whose {} power is too {} for a double; give "
      "them in another unit",
      name, spread, power, spread < 1 ? "small" : "large");
}

}  // namespace

void Histogram::merge(const Histogram& other) {
  for (std::size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  below += other.below;
  above += other.above;
}

void add_details(ChannelDetails& details, double value, const ObservationCost& cost) {
  if (!std::isfinite(value)) return;
  if (!details.histogram.counts.empty()) details.histogram.add(value);
  for (std::size_t k = 0; k < details.joint.size(); ++k) details.joint[k].add(value, cost[k]);
  if (details.cells.empty()) return;
  if (!(value >= 0 && value < static_cast<double>(details.cells.size()))) {
    throw std::logic_error("an observation in none of the cells that its pool counts");
  }
  ++details.cells[static_cast<std::size_t>(value)];
}

std::vector<stats::JointMoments> joint_moments(const ChannelDetails& details) {
  return mapped(details.joint, &stats::JointSums::moments);
}

Summary::Summary(std::size_t count_of_channels, std::span<const ChannelPlan> plan)
    : channels(count_of_channels) {
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!plan[i].has_details()) continue;
    ChannelDetails& details = detailed[i];
    details.cells.resize(plan[i].cells);
    if (plan[i].powers != Powers::none) {
      details.joint.resize(plan[i].powers == Powers::with_costs ? std::size_t{counted_costs} : 1);
    }
    if (plan[i].has_histogram()) {
      details.histogram.low = plan[i].histogram_low;
      details.histogram.high = plan[i].histogram_high;
      details.histogram.counts.resize(histogram_bins);
    }
  }
}

void Summary::add_observation(std::span<const double> values, std::uint64_t index,
                              const ObservationCost& counted) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    channels[c].add(values[c], index);
  }
  for (auto& [channel, details] : detailed) add_details(details, values[channel], counted);
}

void Summary::append(const Summary& next) {
  count += next.count;
  group_variances.merge(next.group_variances);
  cost += next.cost;
  seconds += next.seconds;
  for (std::size_t i = 0; i < channels.size(); ++i) channels[i].append(next.channels[i]);
  for (auto& [channel, details] : detailed) merge(details, next.detailed.at(channel));
}

const ChannelDetails& Summary::details(std::size_t channel) const {
  static const ChannelDetails none;
  const auto found = detailed.find(channel);
  return found == detailed.end() ? none : found->second;
}

stats::Moments ElementSums::moments(std::size_t channel) const {
  if (channel == 0) return first;
  if (channel == mean.size()) return average;
  return {.count = count, .mean = mean[channel], .m2 = m2[channel]};
}

stats::MomentArrays ElementSums::room_for(const stats::ImageStack& stack, stats::RowRange rows) {
  mean.resize(stack.extent.elements());
  m2.resize(stack.extent.elements());
  if (rows.first == 0) stats::element_moments(stack, 0, std::span(&first, 1));
  const stats::ElementRange range = rows.elements(stack.extent);
  return stats::MomentArrays{mean, m2}.part(range.first, range.size());
}

void ElementSums::take(const stats::ImageStack& stack, stats::RowRange rows) {
  const stats::MomentArrays moments = room_for(stack, rows);
  const std::size_t row = stack.extent.row();
  on_all_threads(rows.last - rows.first, [&](std::size_t y) {
    stats::moments_of_range(stack, (rows.first + y) * row, moments.part(y * row, row));
  });
}

std::string beyond_doubles(const stats::JointMoments& powers, const std::string& name) {
  if (stats::has_sound_powers(powers)) return "";
  return refusal(name, powers.of_x.maximum - powers.of_x.minimum, "eighth");
}

std::string beyond_doubles(const stats::Moments& moments, const std::string& name) {
  if (stats::has_sound_powers(moments)) return "";
  return refusal(name, moments.maximum - moments.minimum, "fourth");
}

std::vector<ChannelSummary> sums_of_images(Images images) {
  const std::size_t elements = images.front().size();
  return stats::finite_moments({{.width = elements, .height = 1}, {images.begin(), images.end()}},
                               on_all_threads);
}

}  // namespace assay::harness
