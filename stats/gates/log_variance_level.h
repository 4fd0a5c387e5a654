#pragma once

#include <cstdint>
#include <span>

#include "stats/basics/gate.h"

namespace assay::stats {

// Standardised central moments 3 to 6 of one value. The level of log_variance.h depends on them.
struct SixthOrderShape {
  double skewness = 0;
  double kurtosis = 3;  // Not the excess.
  double fifth = 0;
  double sixth = 15;
};

// Throws std::domain_error: fewer than two values, no spread, a value that is not finite.
SixthOrderShape sixth_order_shape(std::span<const double> values);

// The shape of means of `count` such values, by their cumulants: kappa_r / count^(r / 2 - 1).
SixthOrderShape averaged(const SixthOrderShape& shape, std::uint64_t count);

// The smallest count at which the worse tail of the test of ln s2 departs from nominal by a factor
// of at most `level_factor` (> 1). The factor is exp(|B| x^3) at critical value x.
//   B = (g / 3 - c / 2) / sqrt n.
// Here psi = (x - mean)^2 / variance - 1 has variance c^2 = kurtosis - 1. Its skewness is g =
// (sixth - 3 kurtosis + 2) / c^3. The term g / 3 is that of the Studentised mean of psi
// (self-normalised moderate deviations: Jing, Shao & Wang 2003). The term c / 2 is the bend of the
// logarithm. If the two nearly cancel the next order rules. So |B| is at least a seventh of (|g| /
// 3 + c / 2) / sqrt n. The factor is 1 for a two-valued law at 1/2.
std::uint64_t values_for_log_variance(const SixthOrderShape& x, double critical_value,
                                      double level_factor = 1.25);
// The same with two samples, the second of count * allocation. Each B is weighted by its share of
// the variance of the difference to the power 3/2. Their absolute values add up, which is a bound.
std::uint64_t values_for_log_variance(const SixthOrderShape& x, const SixthOrderShape& y,
                                      double critical_value, double level_factor = 1.25,
                                      double allocation = 1);

// The same for ln of a mean of positive values such as costs. They have standard deviation over
// mean c and skewness g. Then psi is value / mean - 1, and a quarter replaces the seventh. With
// rare and dear costs the tails are up to 1.7 times their level at this count.
struct PositiveShape {
  double variation = 0;
  double skewness = 0;
};
std::uint64_t values_for_log_mean(PositiveShape x, double critical_value,
                                  double level_factor = 1.25);
// The |B| sqrt n of it, and the share of an error of |g| / 3 that enters.
struct LogMeanSlope {
  double value = 0;
  double share_of_skewness = 1;
};
LogMeanSlope log_mean_slope(PositiveShape x);

}  // namespace assay::stats
