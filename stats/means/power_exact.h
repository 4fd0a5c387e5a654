#pragma once

#include <cstdint>
#include <optional>

#include "stats/means/bounded_mean.h"
#include "stats/planning/power.h"

namespace assay::stats {

// Power of the exact tests of a mean in a declared range, on the range's own scale: effects are
// differences of the mean, positive ones above the null value. n observations. A two-sided test
// rejects each tail at alpha / 2; a one-sided one rejects the tail on the effect's side at alpha.
// Where null_mean +- allow or the mean it is asked about lies outside the range: power 1, as such a
// null is impossible and such an effect cannot be. Throw std::domain_error for n < 1 (bounded: 2),
// rates outside (0, 1), allow < 0, an effect of 0.
struct ExactMeanPlan {
  Range range;
  double null_mean = 0.5;
  double standard_deviation = 0.5;  // bounded: of one observation; binomial: unused
  double allow = 0;
  ErrorRates rates;
};

// two_valued_mean: exact, the probability of a count that the test rejects.
double binomial_power(const ExactMeanPlan& plan, std::uint64_t n, double effect);
// bounded_mean: the smallest sample mean that its bounds reject where the sample's deviation is the
// planned one; the probability of a larger one by the normal law.
double bounded_power(const ExactMeanPlan& plan, std::uint64_t n, double effect);

enum class ExactMethod { binomial, bounded };
// The least effect on this side (1 above, -1 below) with power 1 - beta; nullopt where the range
// ends before it.
std::optional<double> exact_detectable(ExactMethod method, const ExactMeanPlan& plan,
                                       std::uint64_t n, int side);
// The least n, within half a per cent, at which every sample rejects the null at alpha or the
// effect at beta, so that the effect has power 1 - beta; and as many at twice n, as the power of a
// count is no smooth function of n. Of a bounded mean with the planned deviation. nullopt beyond
// 2^40.
std::optional<std::uint64_t> exact_sample_size(ExactMethod method, const ExactMeanPlan& plan,
                                               double effect);

}  // namespace assay::stats
