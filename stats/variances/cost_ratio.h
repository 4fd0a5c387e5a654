#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Relative tolerance for equal costs. It is larger than the rounding of a claim's factor, its
// logarithm and a product. It is smaller than the difference of any two whole costs below 1e12.
inline constexpr double cost_rounding = 1e-12;

// Null hypothesis: E cost x / E cost y = null_ratio, both costs positive. Delta method:
//   L = ln(mean x / mean y) - ln null_ratio,  SE^2 = sum s2 / (n mean^2),  Z = L / SE.
// Asymptotic. One cost may be constant. If both are constant over their samples, costs count as
// deterministic. The ratios are then compared exactly but for cost_rounding of the larger. The law
// is "bound", and a ratio that differs has the smallest log p on its side. For means of any sign
// use welch_ratio_interval. Throws std::domain_error (count < 2, mean or null_ratio not positive).
TestResult log_cost_ratio(const Moments& cost_x, const Moments& cost_y, double null_ratio);

// Central interval of ln(E cost x / E cost y). A single point if both are constant.
Interval log_cost_ratio_interval(const Moments& cost_x, const Moments& cost_y, double confidence);

// Null hypothesis: E cost = null_cost. The rest as above with ln(mean / null_cost).
TestResult log_cost(const Moments& cost, double null_cost);
Interval log_cost_interval(const Moments& cost, double reference_cost, double confidence);

}  // namespace assay::stats
