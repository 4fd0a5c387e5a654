#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "stats/tails/tails.h"

namespace assay::stats {

inline constexpr const char* effect_over_cells = "effect size w over the cells";

struct PooledCell {
  std::uint64_t observed = 0;
  double expected = 0;               // n p0.
  std::vector<std::size_t> members;  // Indices of the caller's cells.
};

// The distance of a law p1 from the null law p0. Counts O of n >= 4 multinomial observations
// estimate it, with p0 > 0 (Cohen 1988). The p0 sum to 1.
//   w^2 = sum (p1 - p0)^2 / p0 = E_0 d^2,  d = p1 / p0 - 1.
// Falling factorials O (O-1) ... / n (n-1) ... estimate sums over d without bias.
class CellEffect {
 public:
  static constexpr std::uint64_t fewest_observations = 4;

  // Throws std::domain_error where n is less.
  CellEffect(std::span<const PooledCell> cells, std::uint64_t observations);

  // The unbiased estimate U = sum O (O-1) / (n (n-1) p0) - 1 of w^2, which may be negative.
  double squared() const { return squared_; }

  // Tails of U if w were null_effect. The upper tail is small where w is larger, the lower where it
  // is smaller. The variance of U is (Hoeffding 1948)
  //   4 (n-2)/(n (n-1)) z1 + 2/(n (n-1)) z2.
  // Here z1 = w^2 + E_0 d^3 - w^4, the variance of p1/p0 under p1.
  // And z2 = sum (p1/p0)^2 - (1 + w^2)^2.
  // In it d is the data's, scaled to the null effect by at most 2. Neither part is below that of
  // noncentral chi-square, w^2 and K - 1. So a cell that carries the effect enlarges the variance.
  // The law of U is taken for noncentral chi-square of K - 1 degrees and n w^2, moved to this mean
  // and variance. For the upper tail both parameters are divided so that the skewness matches the
  // data's excess. That excess is n (56 E_0 d^3 + 32 E_0 d^4) in the third cumulant of n U.
  // Asymptotic; see measurements.md.
  LogTails tails(double null_effect) const;

  // n U moved to the mean and variance of noncentral chi-square of K - 1 degrees and n
  // null_effect^2. Its lower tail there is that of tails(). Its upper tail is less skew.
  double statistic(double null_effect) const;

 private:
  struct AtNull;
  AtNull at_null(double null_effect) const;
  double moved(const AtNull& law, double null_effect, Noncentral to) const;

  double n_;
  double cells_;
  double squared_ = 0;
  double third_ = 0;        // E_0 d^3.
  double fourth_ = 0;       // E_0 d^4.
  double sum_ = 0;          // Sum of d over the cells.
  double sum_squares_ = 0;  // Sum of d^2.
};

// Central interval of an effect w >= 0. `tails(w)` are the data's tails if w were the effect. The
// upper one rises with w and the lower one falls. The low end is at least 0. The high end is sought
// from `start` on, and infinite if no w is too large. Both ends are NaN if the lower tail rejects
// even w = 0: such data are closer to the null law than chance allows.
Interval effect_interval(const std::function<LogTails(double)>& tails, double start,
                         double confidence);

}  // namespace assay::stats
