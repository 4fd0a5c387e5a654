#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/power.h"
#include "stats/test_result.h"

namespace assay::stats {

// When a growing sample is looked at, and which share of the error each look may spend. The data
// are cumulative: look k sees the first sizes[k] observations. Sizes ascend strictly; weights are
// positive and sum to at most 1. Both are fixed before the first observation.
struct LookSchedule {
  std::vector<std::uint64_t> sizes;
  std::vector<double> weights;
};

struct LookRange {
  std::uint64_t first = 1;  // n_0
  std::uint64_t last = 1;   // the largest sample, always the last look
};

// n_k = n_0 r^k from range.first to range.last, rounded to whole numbers, with equal weights 1 / K.
// K is the smallest number of looks whose ratio does not exceed `growth`; r is then evened out so
// that the last look is range.last exactly. Looks that round to the same size are one look. Ratios
// of 1.5 to 4 are sensible: smaller ones spend level on looks that hardly differ. Throws
// std::domain_error: first < 1, last < first, growth not finite and above 1.
LookSchedule geometric_looks(LookRange range, double growth);

// The same sizes with weights proportional to these positive numbers, one for each look.
LookSchedule with_weights(LookSchedule schedule, std::span<const double> proportions);

// Null hypothesis: that of every look. P = min over the looks taken of p_k / w_k, at most 1:
// P(P <= a) <= sum w_k a <= a whatever the dependence between looks and wherever one stops
// (Bonferroni 1936, weighted), if every p_k is valid for its own fixed size. `log_p` holds ln p_k
// of the first looks, in order. Throws std::domain_error: no look or more than scheduled, a
// malformed schedule, a log p above 0 or NaN.
double log_p_over_looks(const LookSchedule& schedule, std::span<const double> log_p);

// Both one-sided p-values of a method over its looks, each combined as above. Statistic and law are
// those of the latest look; exact only if every look is.
TestResult over_looks(const LookSchedule& schedule, std::span<const TestResult> results);

// The confidence for look k's own interval, 1 - w_k (1 - confidence): the intersection of these
// intervals over all looks then holds the parameter with probability `confidence`.
double look_confidence(const LookSchedule& schedule, std::size_t look, double confidence);

// The intersection, with `confidence` as its confidence. An empty one (low > high) is returned as
// it is: it says that the looks contradict each other. Throws std::domain_error when given none.
Interval intersection(std::span<const Interval> intervals, double confidence);

// The rates of one look that spends this weight of both errors: what a method's sample_size needs
// so that the last look decides.
ErrorRates look_rates(ErrorRates rates, double weight);

// Largest sample with looks over the fixed sample size, at the same power, for a method near the
// normal law: ((z_{alpha w} + z_beta) / (z_alpha + z_beta))^2, z_alpha at alpha / 2 when two-sided.
// beta = 0.5 compares the two at the boundary of detection.
double look_cost(ErrorRates rates, double weight);

}  // namespace assay::stats
