#pragma once

#include "stats/basics/moments.h"

namespace assay::stats {

// Standard deviation of what rounding adds to x.mean, of values given to Moments::add and merged in
// any order: ulp / sqrt(12), ulp the spacing of doubles at the mean. Moments keeps what is
// lost at every step, so that the last is the only one. 0 where the values do not vary.
double rounding_of_mean(const Moments& x);

}  // namespace assay::stats
