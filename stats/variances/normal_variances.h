#pragma once

#include <optional>

#include "stats/basics/moments.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// Null hypothesis: Var x = null_variance. X = (n - 1) s2 / null_variance ~ chi-square, nu = n - 1.
// Exact for normal data and only there. An excess kurtosis k inflates the statistic's standard
// deviation by sqrt(1 + k/2) for every n (see assumption_gates.h). Throws std::domain_error (count
// < 2, null_variance not positive and finite), ZeroVariance (s2 = 0).
TestResult chi_square_variance(const Moments& x, double null_variance);

// Null hypothesis: Var x / Var y = null_ratio. F = (s2x / s2y) / null_ratio ~ F(nx - 1, ny - 1).
// Exact for two independent normal samples and only there (see assumption_gates.h). Throws
// std::domain_error (count < 2, null_ratio not positive and finite), ZeroVariance.
TestResult f_ratio(const Moments& x, const Moments& y, double null_ratio);

// Evidence about theta = ln(Var x / null), or about ln(Var x / Var y / null), by these tests.
Evidence log_variance_evidence(const Moments& x, const std::optional<Moments>& y, double null);

}  // namespace assay::stats
