#pragma once

#include <cstdint>

#include "stats/bounded_mean.h"
#include "stats/moments.h"
#include "stats/test_result.h"

namespace assay::stats {

// How the bets are sized. `error`: the one-sided error for which they are near their best; any
// other error stays valid. `planned_count`: when not zero, the number of values at which they are
// best, known before the first value is seen; otherwise they shrink for sequences without a plan.
struct BoundedDesign {
  Range range;
  double error = 1e-3;
  std::uint64_t planned_count = 0;
};

// Null hypothesis: E (x_i | past) = m, for values in a declared range that come in blocks of which
// only the moments are known. Predictable empirical-Bernstein process (Waudby-Smith & Ramdas 2024,
// J. R. Statist. Soc. B 86, theorem 2), with one bet l_b and one
// forecast mu_b a block, both from the blocks before it, on the unit scale:
//   ln E+(m) = sum_b l_b n_b (mean_b - m) - psi(l_b) (M2_b + n_b (mean_b - mu_b)^2),
//   ln E-(m) likewise with m - mean_b,      psi(l) = -ln(1 - l) - l
//   l_b  = min(1/2, sqrt(2 ln(2 / error) / (N_b ln(1 + N_b) v_b))),  N_b values up to this block,
//          with planned_count  N ln(1 + N) -> max(N_b, planned_count)
//   mu_b, v_b: mean and variance of the values before, with one value 1/2 of variance 1/4 added
// Under the null E+ and E- are non-negative supermartingales from 1, so p = min(1, 1 / E) holds at
// every look (after any block), for every law inside the range and every n: no gates are needed.
// Block sizes must be chosen without the block's values. State is five numbers; blocks go in order,
// processes cannot be merged. m may be chosen after the fact, as bets do not depend on it.
class BoundedProcess {
 public:
  // Throws std::domain_error: range empty or infinite, error outside (0, 1).
  explicit BoundedProcess(BoundedDesign design);

  void add(const Moments& block);  // throws std::domain_error: values outside the range

  // Statistic: mean - null_mean; both logarithms of p as above. A null mean outside the range is
  // impossible: the tail that rejects it has the lowest logarithm. Throws std::domain_error: no
  // values, non-finite null_mean.
  TestResult result(double null_mean) const;

  // Central interval of the mean, in closed form: centre sum l n mean / sum l n, half-width
  // (ln(1 / one-sided error) + sum psi (...)) / sum l n; cut to the range. Simultaneous over looks.
  Interval interval(double confidence) const;

 private:
  double next_bet(double block_count) const;
  double centre() const;  // unit scale

  BoundedDesign design_;
  Moments seen_;          // unit scale
  double stakes_ = 0;     // sum l_b n_b
  double winnings_ = 0;   // sum l_b n_b mean_b
  double variation_ = 0;  // sum psi(l_b) (M2_b + n_b (mean_b - mu_b)^2)
};

}  // namespace assay::stats
