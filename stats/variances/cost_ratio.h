#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Relative: more than the rounding of a claim's factor, its logarithm and a product, and less than
// any two whole costs below 1e12 differ by.
inline constexpr double cost_rounding = 1e-12;

// Null hypothesis: E cost x / E cost y = null_ratio, both costs positive.
//   L = ln(mean x / mean y) - ln null_ratio,  SE^2 = sum s2 / (n mean^2),  Z = L / SE  (delta
//   method)
// Asymptotic. One cost may be constant. When both are constant over their samples, costs count as
// deterministic: the ratios are compared exactly but for cost_rounding of the larger, the law is
// "bound", and a ratio that differs has the smallest log p on its side. (welch_ratio_interval gives
// Fieller's interval for means of any sign.) Throws std::domain_error (count < 2, mean or
// null_ratio not positive).
TestResult log_cost_ratio(const Moments& cost_x, const Moments& cost_y, double null_ratio);

// Central interval of ln(E cost x / E cost y); a single point when both are constant.
Interval log_cost_ratio_interval(const Moments& cost_x, const Moments& cost_y, double confidence);

// Null hypothesis: E cost = null_cost; all as above with ln(mean / null_cost).
TestResult log_cost(const Moments& cost, double null_cost);
Interval log_cost_interval(const Moments& cost, double reference_cost, double confidence);

}  // namespace assay::stats
