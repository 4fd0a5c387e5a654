#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Of each sample, to be allowed for; 0 or more.
struct ExcessKurtoses {
  double x = 0;
  double y = 0;
};

// Null hypothesis: Var x / Var y = null_ratio. F = (s2x / s2y) / null_ratio ~ F(nx - 1, ny - 1).
// Exact for two independent normal samples and only there (see assumption_gates.h). Where excess
// kurtoses k > 0 are to be allowed for, the degrees are (n - 1) / (1 + k/2), each side its own (Box
// and Andersen 1955), and F is approximate.
// Throws std::domain_error (count < 2, null_ratio not positive and finite, k negative or not
// finite), ZeroVariance.
TestResult f_ratio(const Moments& x, const Moments& y, double null_ratio,
                   const ExcessKurtoses& allowed = {});

// Central interval of Var x / Var y.
Interval f_ratio_interval(const Moments& x, const Moments& y, double confidence,
                          const ExcessKurtoses& allowed = {});

}  // namespace assay::stats
