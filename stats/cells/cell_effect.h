#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/tails/tails.h"

namespace assay::stats {

struct PooledCell {
  std::uint64_t observed = 0;
  double expected = 0;               // n p0
  std::vector<std::size_t> members;  // indices of the caller's cells
};

// Counts O of n >= 4 multinomial observations in cells of probabilities p0 > 0 that sum to 1, and
// how far their law p1 lies from p0:
//   w^2 = sum (p1 - p0)^2 / p0 = E_0 d^2,  d = p1 / p0 - 1  (Cohen 1988).
// Sums over d are estimated without bias by falling factorials, O (O-1) ... / n (n-1) ...
class CellEffect {
 public:
  static constexpr std::uint64_t fewest_observations = 4;

  // Throws std::domain_error where n is less.
  CellEffect(std::span<const PooledCell> cells, std::uint64_t observations);

  // The unbiased estimate U = sum O (O-1) / (n (n-1) p0) - 1 of w^2, which may be negative.
  double squared() const { return squared_; }

  // Tails of U if w were null_effect: upper is small where w is larger, lower where it is smaller.
  // U has the variance
  //   4 (n-2)/(n (n-1)) z1 + 2/(n (n-1)) z2,  z1 = w^2 + E_0 d^3 - w^4 (variance of p1/p0 under
  //   p1), z2 = sum (p1/p0)^2 - (1 + w^2)^2
  // (Hoeffding 1948), in which d is that of the data, shrunk or stretched to the null effect, by 2
  // at most; neither part below that of noncentral chi-square, w^2 and K - 1. Where one cell
  // carries the effect the variance is larger by as much as p1 / p0 there. The law of U is taken
  // for a noncentral chi-square of K - 1 degrees and n w^2, moved to this mean and variance; of the
  // upper tail both parameters are divided so that its skewness has the excess of the data's, n (56
  // E_0 d^3 + 32 E_0 d^4) in the third cumulant of n U. Asymptotic; figures: README.md.
  LogTails tails(double null_effect) const;

  // n U moved to the mean and the variance of noncentral chi-square of K - 1 degrees and
  // n null_effect^2: its lower tail there is that of tails(), its upper one less skew.
  double statistic(double null_effect) const;

 private:
  struct AtNull;
  AtNull at_null(double null_effect) const;
  double moved(const AtNull& law, double null_effect, Noncentral to) const;

  double n_;
  double cells_;
  double squared_ = 0;
  double third_ = 0;        // E_0 d^3
  double fourth_ = 0;       // E_0 d^4
  double sum_ = 0;          // of d over the cells
  double sum_squares_ = 0;  // of d^2
};

}  // namespace assay::stats
