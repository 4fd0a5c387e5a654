#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Null hypothesis: Var x = null_variance, any law with four moments.
//   L = ln(s2 / null_variance),  SE^2 = (b2 - (n - 3) / (n - 1)) / n,  Z = L / SE ~ normal.
// SE^2 is the delta method on the exact Var(s2) = s2^2 (b2 - (n - 3) / (n - 1)) / n. Asymptotic:
// use n >= 1000, and more for skewed data (measurements.md has levels). Throws std::domain_error
// (count < 4, null_variance not positive and finite), ZeroVariance (s2 = 0).
TestResult log_variance(const Moments& x, double null_variance);

// Central interval of ln(Var x / reference_variance).
Interval log_variance_interval(const Moments& x, double reference_variance, double confidence);

// Null hypothesis: Var x / Var y = null_ratio. The standard errors keep separate kurtoses, so the
// two laws may differ in shape. Prefer equal sample sizes: unequal ones lose level on skewed data.
//   L = ln(s2x / s2y) - ln(null_ratio),  SE^2 = sum of the two SE^2 above.
TestResult log_variance_ratio(const Moments& x, const Moments& y, double null_ratio);

// Central interval of ln(Var x / Var y).
Interval log_variance_ratio_interval(const Moments& x, const Moments& y, double confidence);

// SE of ln s2 as above, also for a delta method that combines it with other terms.
double log_variance_standard_error(const Moments& x);

}  // namespace assay::stats
