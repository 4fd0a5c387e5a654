#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace assay::stats {

// Correlations of values that stand further apart than neighbours, as of chains that were written
// step by step, one value of each in turn. Of ranks, equal values in an order drawn by their
// places: a correlation of heavy-tailed values themselves, or of a rare one among equals, is that
// of a few pairs. For lag k = 2 ... K,
//   z_k = (r_k + 1 / n) n / sqrt(n - k),   K = min(n / 4, 1000, 2e8 / n),
// near standard normal for independent values of any one law.
struct LaggedCorrelation {
  std::size_t lag = 0;
  double correlation = 0;  // r_k
  double z = 0;
};

// All of them; none where n < 8 or all values are equal. Time n K.
std::vector<LaggedCorrelation> lagged_correlations(std::span<const double> values);

// The one whose z is farthest from 0; of lag 0 where there is none.
LaggedCorrelation worst_of(std::span<const LaggedCorrelation> all);

}  // namespace assay::stats
