#pragma once

#include <cstdint>
#include <span>

#include "stats/basics/gate.h"

namespace assay::stats {

// Standardised central moments 3 to 6 of one value: what the level of log_variance.h depends on.
struct SixthOrderShape {
  double skewness = 0;
  double kurtosis = 3;  // not the excess
  double fifth = 0;
  double sixth = 15;
};

// Throws std::domain_error: fewer than two values, no spread, a value that is not finite.
SixthOrderShape sixth_order_shape(std::span<const double> values);

// Of means of `count` such values, through their cumulants: kappa_r / count^(r / 2 - 1).
SixthOrderShape averaged(const SixthOrderShape& shape, std::uint64_t count);

// A planned test of one sample of `count` values, or of two, the second of count * allocation.
struct PlannedLogVariance {
  std::uint64_t count = 2;
  double critical_value = 0;
  double allocation = 1;
};

// The factor by which the worse tail of the test of ln s2 departs from nominal,
//   exp(|B| x^3),   B = (g / 3 - c / 2) / sqrt n,
// where psi = (x - mean)^2 / variance - 1 has variance c^2 = kurtosis - 1 and skewness
//   g = (sixth - 3 kurtosis + 2) / c^3:
// g / 3 from the Studentised mean of psi (self-normalised moderate deviations: Jing, Shao & Wang
// 2003), c / 2 from the bend of the logarithm. Where the two nearly cancel the next order is what
// counts: |B| is taken to be at least a seventh of their sum, |g| / 3 + c / 2, over sqrt n. With
// two samples the B of each, weighted by its share of the variance of the difference to the power
// 3/2, are subtracted; the factor takes their absolute values added, a bound. 1 for a two-valued
// law at 1/2, whose ln s2 has no first order.
double log_variance_level_factor(const SixthOrderShape& x, PlannedLogVariance plan);
double log_variance_level_factor(const SixthOrderShape& x, const SixthOrderShape& y,
                                 PlannedLogVariance plan);

// The smallest count at which that factor is at most `level_factor` (> 1).
std::uint64_t values_for_log_variance(const SixthOrderShape& x, double critical_value,
                                      double level_factor = 1.25);
std::uint64_t values_for_log_variance(const SixthOrderShape& x, const SixthOrderShape& y,
                                      double critical_value, double level_factor = 1.25,
                                      double allocation = 1);

// The same of ln of a mean of positive values with standard deviation over mean c and skewness g, a
// cost: psi is then value / mean - 1, and a quarter stands for the seventh. Of costs that are rare
// and dear the tails are up to 1.7 times their level at this count (exact, binomial).
struct PositiveShape {
  double variation = 0;
  double skewness = 0;
};
std::uint64_t values_for_log_mean(PositiveShape x, double critical_value,
                                  double level_factor = 1.25);
// |B| sqrt n of that, and how much of an error of |g| / 3 enters it.
struct LogMeanSlope {
  double value = 0;
  double share_of_skewness = 1;
};
LogMeanSlope log_mean_slope(PositiveShape x);

}  // namespace assay::stats
