#pragma once

#include <cstdint>
#include <optional>

#include "stats/means/betting_mean.h"
#include "stats/planning/power.h"

namespace assay::stats {

// Power of the exact tests of a mean in a declared range. Effects are differences of the mean on
// the range's own scale, positive above the null value. A two-sided test rejects each tail at alpha
// / 2. A one-sided one rejects the tail on the effect's side at alpha. The power is 1 if null_mean
// +- allow or the mean in question lies outside the range. All throw std::domain_error for n < 1,
// rates outside (0, 1), allow < 0, an effect of 0.
struct ExactMeanPlan {
  Range range;
  double null_mean = 0.5;
  const ValueCells* law = nullptr;  // For bets: the values, about any mean.
  double allow = 0;
  ErrorRates rates;
};

struct ExactPlanning {
  double (*power)(const ExactMeanPlan&, std::uint64_t n, double effect);
  // The least n at which the effect has power 1 - beta. Nothing beyond 2^40.
  std::optional<std::uint64_t> (*sample_size)(const ExactMeanPlan&, double effect);
};

// For two_valued_mean: the exact probability of a count that the test rejects. The size is within
// half a per cent. There and at twice the size the effect has its power. (The power of a count is
// no smooth function of n.)
extern const ExactPlanning binomial_planning;

// For betting_mean: the logarithm of the best bet's wealth is taken for normal. The values are
// those of the law, moved to the mean in question. An end of the range that is infinite has power
// 0.
extern const ExactPlanning betting_planning;

// The least effect on this side (1 above, -1 below) with power 1 - beta. Nothing if the range ends
// before it.
std::optional<double> exact_detectable(const ExactPlanning& method, const ExactMeanPlan& plan,
                                       std::uint64_t n, int side);

// The least n that rejects the claimed region where theta is `effect`. It also rejects the
// forbidden region at beta where theta is at the claimed region's edge.
std::optional<std::uint64_t> exact_sample_size(const ExactPlanning& method,
                                               const ExactMeanPlan& claimed, double effect);

}  // namespace assay::stats
