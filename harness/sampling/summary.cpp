#include "harness/sampling/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "harness/base/parallel.h"
#include "stats/images/image_moments.h"

namespace assay::harness {
namespace {

void merge(ChannelDetails& ours, const ChannelDetails& theirs) {
  ours.histogram.merge(theirs.histogram);
  for (std::size_t cell = 0; cell < ours.cells.size(); ++cell) {
    ours.cells[cell] += theirs.cells[cell];
  }
  for (std::size_t k = 0; k < ours.joint.size(); ++k) ours.joint[k].merge(theirs.joint[k]);
}

/// A quick test that settles nearly all of an image's millions of elements.
bool are_ordinary(const stats::Moments& moments) {
  return moments.m2 > 1e-60 && moments.m2 < 1e60 && std::abs(moments.m3) < 1e90 &&
         moments.m4 > 1e-120 && moments.m4 < 1e120;
}

// Denormal numbers have lost their digits.
constexpr double least =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

std::string refusal(const std::string& name, double spread, const char* power) {
  return fmt::format(
      "the observations of `{}` spread over {:.3g}, whose {} power is too {} for a double; give "
      "them in another unit",
      name, spread, power, spread < 1 ? "small" : "large");
}

constexpr std::size_t channels_at_a_time = 4096;

/// Adds values one by one, as elsewhere; non-finite ones are counted apart.
ChannelSummary one_by_one(const stats::ImageStack& stack, std::size_t channel) {
  ChannelSummary summary;
  for (std::size_t i = 0; i < stack.images.size(); ++i) {
    add_observation(summary, *stack.at(i, channel), i);
  }
  return summary;
}

void take(const stats::ImageStack& stack, std::size_t first, std::span<ChannelSummary> out) {
  std::vector<stats::Moments> moments(out.size());
  stats::element_moments(stack, first, moments);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (std::isfinite(moments[i].m2)) {
      out[i].moments = moments[i];
    } else {
      out[i] = one_by_one(stack, first + i);
    }
  }
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
    harness::add_observation(channels[c], values[c], index);
  }
  for (auto& [channel, details] : detailed) add_details(details, values[channel], counted);
}

void Summary::append(const Summary& next) {
  count += next.count;
  group_variances.merge(next.group_variances);
  cost += next.cost;
  seconds += next.seconds;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    ChannelSummary& ours = channels[i];
    const ChannelSummary& theirs = next.channels[i];
    ours.moments.merge(theirs.moments);
    ours.nonfinite += theirs.nonfinite;
    ours.first_nonfinite = std::min(ours.first_nonfinite, theirs.first_nonfinite);
  }
  for (auto& [channel, details] : detailed) merge(details, next.detailed.at(channel));
}

const ChannelDetails& Summary::details(std::size_t channel) const {
  static const ChannelDetails none;
  const auto found = detailed.find(channel);
  return found == detailed.end() ? none : found->second;
}

void Extremes::add(std::span<const float> values) {
  // So many numbers have extremes of their own, so that none waits for the last.
  constexpr std::size_t apart = 32;
  std::array<float, apart> low;
  std::array<float, apart> high;
  std::array<std::uint32_t, apart> not_zero{};
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  const auto take = [&](float value, std::size_t k) {
    low[k] = value < low[k] ? value : low[k];
    high[k] = value > high[k] ? value : high[k];
    not_zero[k] += value != 0 ? 1 : 0;
  };
  const std::size_t whole = values.size() / apart * apart;
  for (std::size_t i = 0; i < whole; i += apart) {
    for (std::size_t k = 0; k < apart; ++k) take(values[i + k], k);
  }
  for (std::size_t i = whole; i < values.size(); ++i) take(values[i], i - whole);
  minimum = std::min(minimum, double{*std::ranges::min_element(low)});
  maximum = std::max(maximum, double{*std::ranges::max_element(high)});
  nonzero += std::accumulate(not_zero.begin(), not_zero.end(), std::uint64_t{0});
}

void Extremes::merge(const Extremes& other) {
  minimum = std::min(minimum, other.minimum);
  maximum = std::max(maximum, other.maximum);
  nonzero += other.nonzero;
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
  const double highest = powers.sum(powers.known, 0);
  const bool sound = highest > least && std::ranges::all_of(powers.sums, [](double sum) {
                       return std::isfinite(sum);
                     });
  if (sound) return "";
  return refusal(name, powers.of_x.maximum - powers.of_x.minimum, "eighth");
}

std::string beyond_doubles(const stats::Moments& moments, const std::string& name) {
  if (moments.count < 2 || are_ordinary(moments)) return "";
  const double spread = moments.maximum - moments.minimum;
  const bool sound = moments.m2 * moments.m2 > least && std::isfinite(moments.m2) &&
                     std::isfinite(moments.m4) && moments.m4 > least &&
                     std::isfinite(moments.skewness()) && std::isfinite(moments.kurtosis());
  if (sound) return "";
  return refusal(name, spread, "fourth");
}

std::vector<ChannelSummary> sums_of_images(Images images) {
  const std::size_t elements = images.front().size();
  const stats::ImageStack stack{{.width = elements, .height = 1}, {images.begin(), images.end()}};
  std::vector<ChannelSummary> sums(elements);
  on_all_threads((elements + channels_at_a_time - 1) / channels_at_a_time, [&](std::size_t i) {
    const std::size_t first = i * channels_at_a_time;
    const std::size_t size = std::min(channels_at_a_time, elements - first);
    take(stack, first, std::span(sums).subspan(first, size));
  });
  return sums;
}

}  // namespace assay::harness
