#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Excess kurtosis of each sample that the test allows for, 0 or more.
struct ExcessKurtoses {
  double x = 0;
  double y = 0;
};

// Null hypothesis: Var x / Var y = null_ratio. F = (s2x / s2y) / null_ratio ~ F(nx - 1, ny - 1).
// Exact for two independent normal samples and only there (see assumption_gates.h). With excess
// kurtoses k > 0 the degrees are (n - 1) / (1 + k/2), each side its own (Box & Andersen 1955). F is
// then approximate. Throws std::domain_error (count < 2, null_ratio not positive and finite, k
// negative or not finite), ZeroVariance.
TestResult f_ratio(const Moments& x, const Moments& y, double null_ratio,
                   const ExcessKurtoses& allowed = {});

// Central interval of Var x / Var y.
Interval f_ratio_interval(const Moments& x, const Moments& y, double confidence,
                          const ExcessKurtoses& allowed = {});

}  // namespace assay::stats
