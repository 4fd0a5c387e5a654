#pragma once

#include <cstdint>
#include <span>

#include "stats/bounded_mean.h"
#include "stats/test_result.h"

namespace assay::stats {

// How the bets are sized. `error`: the one-sided error for which they are near their best; any
// other error stays valid.
struct Betting {
  Range range;
  double error = 1e-3;
};

// Null hypothesis: E (x_i | past) = null_mean, for values in a declared range, taken in order. Two
// wagers against it, predictable bets l_i (Waudby-Smith & Ramdas 2024, J. R. Statist. Soc. B 86,
// theorem 3), on the unit scale:
//   K+ = prod (1 + min(l_i, 1 / (2 m)) (x_i - m)),  K- = prod (1 - min(l_i, 1 / (2 (1 - m))) (x_i -
//   m)) l_i  = sqrt(2 ln(2 / error) / (i ln(1 + i) v_(i-1))),  v_i = (1/4 + sum (x_j - mu_j)^2) /
//   (i + 1), mu_i = (1/2 + sum x_j) / (i + 1)
// Under the null each is a non-negative martingale from 1, so p = min(1, 1 / K) is valid at any
// stopping rule (Ville 1939), whatever the law inside the range. Order matters, so it cannot be
// merged: for blocks of many values use bounded_process.h. (A block mean is a value of the same
// range and may be added, but a bet cannot exceed 1 / (2 m) a mean, which costs power as soon as
// blocks are longer than about Var x / (m |E x - m|).)
class BettingMean {
 public:
  // Throws std::domain_error: range empty or infinite, error outside (0, 1), non-finite null_mean.
  BettingMean(Betting betting, double null_mean);

  void add(double value);  // throws std::domain_error outside the range

  double log_e_above() const;  // ln K+, evidence that the mean exceeds null_mean
  double log_e_below() const;  // ln K-
  // Statistic: mean - null_mean. log_p_upper = min(0, -ln K+), log_p_lower = min(0, -ln K-).
  TestResult result() const;

 private:
  double next_bet() const;

  Betting betting_;
  double null_mean_ = 0;
  double unit_null_ = 0;
  double count_ = 0;
  double sum_ = 0;
  double squares_ = 0;  // sum (x_j - mu_j)^2
  double log_above_ = 0;
  double log_below_ = 0;
};

// The whole sequence at once.
TestResult betting_mean(std::span<const double> values, Betting betting, double null_mean);
// Central interval of the mean by inversion, valid at any stopping rule. The bets do not depend on
// m and K+ falls with m, so the set that is not rejected is an interval.
Interval betting_mean_interval(std::span<const double> values, Betting betting, double confidence);

}  // namespace assay::stats
