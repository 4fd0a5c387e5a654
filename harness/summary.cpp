#include "harness/summary.h"

#include <algorithm>

namespace assay::harness {

void Histogram::merge(const Histogram& other) {
  for (std::size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  below += other.below;
  above += other.above;
}

Summary::Summary(std::span<const ChannelPlan> plan) : channels(plan.size()) {
  for (std::size_t i = 0; i < plan.size(); ++i) {
    channels[i].cells.resize(plan[i].cells);
    if (plan[i].with_cost) channels[i].with_cost.resize(counted_costs);
    if (plan[i].histogram_low < plan[i].histogram_high) {
      channels[i].histogram.low = plan[i].histogram_low;
      channels[i].histogram.high = plan[i].histogram_high;
      channels[i].histogram.counts.resize(histogram_bins);
    }
  }
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
    ours.histogram.merge(theirs.histogram);
    for (std::size_t cell = 0; cell < ours.cells.size(); ++cell) {
      ours.cells[cell] += theirs.cells[cell];
    }
    for (std::size_t k = 0; k < ours.with_cost.size(); ++k) {
      ours.with_cost[k].merge(theirs.with_cost[k]);
    }
    ours.nonfinite += theirs.nonfinite;
    ours.first_nonfinite = std::min(ours.first_nonfinite, theirs.first_nonfinite);
  }
}

}  // namespace assay::harness
