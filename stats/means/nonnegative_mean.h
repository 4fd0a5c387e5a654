#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "stats/tails/test_result.h"

namespace assay::stats {

// Null hypothesis: E (x_i | past) <= null_mean, for non-negative values. It tests "too bright",
// with no assumption on variance, range or n. Constant bets on twelve scales are mixed:
//   E = (1/12) sum_k prod_i (1 + l_k (x_i / null_mean - 1)),   l_k = 2^-k, k = 1 ... 12.
// Under the null E is a non-negative supermartingale from 1. So p = min(1, 1 / E) is valid at every
// look. (Ville 1939; betting: Waudby-Smith & Ramdas 2024, J. R. Statist. Soc. B 86.) The best bet
// is about (E x / m - 1) / Var(x / m). A scale off by sqrt 2 keeps at least .83 of its growth, and
// the mixture costs at most ln 12. The opposite claim has no test without a bound on the values. A
// rare large value can make up for what is missing (Bahadur & Savage 1956). So log_p_lower is 0.
class NonnegativeMean {
 public:
  explicit NonnegativeMean(double null_mean);  // Throws std::domain_error: not finite.

  void add(double value);  // Throws std::domain_error: negative or not finite.

  double log_e() const;
  // Statistic: mean - null_mean; law "bound". A null mean below zero, or zero with a positive value
  // seen, is impossible and gives the lowest logarithm. Throws std::domain_error: no values.
  TestResult result() const;

 private:
  static constexpr std::size_t scales = 12;

  double null_mean_ = 0;
  double count_ = 0;
  double mean_ = 0;
  std::array<double, scales> log_wealth_{};
};

TestResult nonnegative_mean(std::span<const double> values, double null_mean);

// The largest lower limit of E x at this confidence (one-sided), by inversion: E falls with the
// null mean. At least 0. There is no upper limit.
double nonnegative_mean_lower_limit(std::span<const double> values, double confidence);

}  // namespace assay::stats
