#pragma once

#include "stats/basics/two_sizes.h"

namespace assay::stats {

// Internal. ln of an upper bound on P(A + B >= gap), A = sup |F_m - F| and B = sup |G_n - G|
// independent, whatever F and G are. Each is dominated by the law with tail min(1, 2 exp(-2 n a^2))
// (Massart 1990); the convolution of the two dominating laws is bounded from above on a grid.
double log_two_suprema_bound(double gap, TwoSizes sizes);

}  // namespace assay::stats
