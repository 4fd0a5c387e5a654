#include "harness/sampling/summary.h"

#include <algorithm>
#include <stdexcept>

namespace assay::harness {

void Histogram::merge(const Histogram& other) {
  for (std::size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  below += other.below;
  above += other.above;
}

namespace {

void count_in(std::vector<std::uint64_t>& cells, double cell) {
  if (!(cell >= 0 && cell < static_cast<double>(cells.size()))) {
    throw std::logic_error("an observation in none of the cells that its pool counts");
  }
  ++cells[static_cast<std::size_t>(cell)];
}

}  // namespace

void add_details(ChannelDetails& details, double value, const ObservationCost& cost) {
  if (!details.histogram.counts.empty()) details.histogram.add(value);
  for (std::size_t k = 0; k < details.joint.size(); ++k) details.joint[k].add(value, cost[k]);
  if (!details.cells.empty()) count_in(details.cells, value);
}

std::vector<stats::JointMoments> joint_moments(const ChannelDetails& details) {
  std::vector<stats::JointMoments> moments;
  for (const stats::JointSums& each : details.joint) moments.push_back(each.moments());
  return moments;
}

Summary::Summary(std::size_t count_of_channels, std::span<const ChannelPlan> plan)
    : channels(count_of_channels) {
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!plan[i].has_details()) continue;
    ChannelDetails& details = channels[i].rare.made();
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

namespace {

void merge(ChannelDetails& ours, const ChannelDetails& theirs) {
  ours.histogram.merge(theirs.histogram);
  for (std::size_t cell = 0; cell < ours.cells.size(); ++cell) {
    ours.cells[cell] += theirs.cells[cell];
  }
  for (std::size_t k = 0; k < ours.joint.size(); ++k) ours.joint[k].merge(theirs.joint[k]);
}

}  // namespace

void Summary::append(const Summary& next) {
  count += next.count;
  group_variances.merge(next.group_variances);
  cost += next.cost;
  seconds += next.seconds;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    ChannelSummary& ours = channels[i];
    const ChannelSummary& theirs = next.channels[i];
    ours.moments.merge(theirs.moments);
    if (ours.rare) merge(ours.rare.made(), theirs.details());
    ours.nonfinite += theirs.nonfinite;
    ours.first_nonfinite = std::min(ours.first_nonfinite, theirs.first_nonfinite);
  }
}

}  // namespace assay::harness
