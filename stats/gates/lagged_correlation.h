#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace assay::stats {

// Rank correlations of values that stand further apart than neighbours. They find chains that were
// written step by step, one value of each in turn. Equal values are ranked in an order drawn by
// their places. For lag k = first ... K,
//   z_k = (r_k + 1 / n) n / sqrt(n - k),   K = min(n / 4, 1000, 2e8 / n).
// Each z_k is near standard normal for independent values of any one law.
struct LaggedCorrelation {
  std::size_t lag = 0;
  double correlation = 0;  // r_k
  double z = 0;
};

// The ranks of the values, less their mean. Equal values are ranked in an order drawn by their
// places.
std::vector<double> centred_ranks(std::span<const double> values);

// All of them; none if n < 8 or all values are equal. Time n K.
std::vector<LaggedCorrelation> lagged_correlations(std::span<const double> values,
                                                   std::size_t first = 2);

// The one whose z is farthest from 0. Its lag is 0 if there is none.
LaggedCorrelation worst_of(std::span<const LaggedCorrelation> all);

}  // namespace assay::stats
