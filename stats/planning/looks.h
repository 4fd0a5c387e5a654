#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace assay::stats {

// When a growing sample is looked at, and which share of the error each look may spend. The data
// are cumulative: look k sees the first sizes[k] observations. Sizes ascend strictly. Weights are
// positive and sum to at most 1. Both are fixed before the first observation.
struct LookSchedule {
  std::vector<std::uint64_t> sizes;
  std::vector<double> weights;
};

struct LookRange {
  std::uint64_t first = 1;  // n_0
  std::uint64_t last = 1;   // Called n_0 below.
};

// n_k = n_0 r^k from range.first to range.last, rounded, with equal weights 1 / K. K is the
// smallest number of looks whose ratio does not exceed `growth`. Then r is evened out so that the
// last look is range.last exactly. Looks that round to the same size are one look. Ratios of 1.5 to
// 4 are sensible: smaller ones spend level on looks that hardly differ. Throws std::domain_error:
// first < 1, last < first, growth not finite and above 1.
LookSchedule geometric_looks(LookRange range, double growth);

// Null hypothesis: that of every look. P = min over the looks taken of p_k / w_k, at most 1. P(P <=
// a) <= sum w_k a <= a, whatever the dependence between looks and wherever one stops (Bonferroni
// 1936, weighted). Every p_k must be valid for its own fixed size. `log_p` holds ln p_k of the
// first looks, in order. Throws std::domain_error: no look or more than scheduled, a malformed
// schedule, a log p above 0 or NaN.
double log_p_over_looks(const LookSchedule& schedule, std::span<const double> log_p);

}  // namespace assay::stats
