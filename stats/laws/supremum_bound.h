#pragma once

#include <cstdint>

namespace assay::stats {

// Sizes of two samples.
struct TwoSizes {
  std::uint64_t m = 1;
  std::uint64_t n = 1;
};

// Internal. Bounds ln P(A + B >= gap) from above, for any F and G. A = sup |F_m - F| and B = sup
// |G_n - G| are independent. The law with tail min(1, 2 exp(-2 n a^2)) dominates each (Massart
// 1990). The convolution of the two dominating laws is bounded from above on a grid.
double log_two_suprema_bound(double gap, TwoSizes sizes);

}  // namespace assay::stats
