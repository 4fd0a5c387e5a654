#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Null hypothesis: Var x = null_variance. X = (n - 1) s2 / null_variance ~ chi-square, nu = n - 1.
// Exact for normal data and only there. An excess kurtosis k inflates the statistic's standard
// deviation by sqrt(1 + k/2) for every n (see assumption_gates.h). Where k > 0 is allowed for, X /
// (1 + k/2) has nu = (n - 1) / (1 + k/2). That law has the mean and variance of s2 (Box 1953) and
// is approximate. For gamma laws of excess .25 to 1 the worse tail at .005 is 1.0 to 1.5 times
// nominal (n = 30, 300). Throws std::domain_error (count < 2, null_variance not positive and
// finite, k negative or not finite), ZeroVariance (s2 = 0).
TestResult chi_square_variance(const Moments& x, double null_variance, double excess_kurtosis = 0);

// Central interval of Var x.
Interval chi_square_variance_interval(const Moments& x, double confidence,
                                      double excess_kurtosis = 0);

}  // namespace assay::stats
