#pragma once

#include "stats/basics/moments.h"

namespace assay::stats {

// Standard deviation of what rounding adds to x.mean: ulp / sqrt(12), ulp the spacing of doubles at
// the mean. The values may be added and merged in any order. Moments keeps what each step loses, so
// only the last rounding counts. 0 if the values do not vary.
double rounding_of_mean(const Moments& x);

}  // namespace assay::stats
