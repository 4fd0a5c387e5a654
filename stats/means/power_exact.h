#pragma once

#include <cstdint>
#include <optional>

#include "stats/means/bounded_mean.h"
#include "stats/planning/power.h"

namespace assay::stats {

// Power of the exact tests of a mean in a declared range. Effects are differences of the mean on
// the range's own scale, positive above the null value. A two-sided test rejects each tail at alpha
// / 2. A one-sided one rejects the tail on the effect's side at alpha. The power is 1 if null_mean
// +- allow or the mean in question lies outside the range. All throw std::domain_error for n < 1
// (bounded: 2), rates outside (0, 1), allow < 0, an effect of 0.
struct ExactMeanPlan {
  Range range;
  double null_mean = 0.5;
  double standard_deviation = 0.5;  // Bounded: of one observation. Binomial: unused.
  double allow = 0;
  ErrorRates rates;
};

// For two_valued_mean: the exact probability of a count that the test rejects.
double binomial_power(const ExactMeanPlan& plan, std::uint64_t n, double effect);
// For bounded_mean: the smallest sample mean that it rejects at the planned deviation, and the
// normal probability of a larger one.
double bounded_power(const ExactMeanPlan& plan, std::uint64_t n, double effect);

enum class ExactMethod { binomial, bounded };
// The least effect on this side (1 above, -1 below) with power 1 - beta. Nothing if the range ends
// before it.
std::optional<double> exact_detectable(ExactMethod method, const ExactMeanPlan& plan,
                                       std::uint64_t n, int side);
// The least n, within half a per cent, at which the effect has power 1 - beta. There every sample
// rejects the null at alpha or the effect at beta, and so it does at twice n. (The power of a count
// is no smooth function of n.) A bounded mean takes the planned deviation. Nothing beyond 2^40.
std::optional<std::uint64_t> exact_sample_size(ExactMethod method, const ExactMeanPlan& plan,
                                               double effect);

}  // namespace assay::stats
