#include "stats/gates/log_variance_level.h"

#include <algorithm>
#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"

namespace assay::stats {
namespace {

// Least |B| as a share of the skewness's and the bend's parts together. It stands for the next
// order where the two cancel. The two parts differ by a seventh of their sum for normal values.
// Costs are often of few outcomes, and need a quarter (measurements.md).
constexpr double least_share_of_variance = 1 / 7.0;
constexpr double least_share_of_mean = 1 / 4.0;

// B sqrt n.
LogMeanSlope slope(PositiveShape psi, double least_share) {
  const double of_skewness = psi.skewness / 3;
  const double of_bend = psi.variation / 2;
  const double difference = std::abs(of_skewness - of_bend);
  const double least = least_share * (std::abs(of_skewness) + of_bend);
  return difference > least ? LogMeanSlope{difference, 1} : LogMeanSlope{least, least_share};
}

// B sqrt n of one sample of n values with this `share` of the variance of the difference.
double slope(const SixthOrderShape& x, double share) {
  const double square = x.kurtosis - 1;
  if (!(square > 0)) return 0;
  const double c = std::sqrt(square);
  const double g = (x.sixth - 3 * x.kurtosis + 2) / (square * c);
  return slope({.variation = c, .skewness = g}, least_share_of_variance).value *
         std::pow(share, 1.5);
}

// B sqrt n with n the size of the first.
double slope_of_both(const SixthOrderShape& x, const SixthOrderShape& y, double allocation) {
  const double of_x = std::max(0.0, x.kurtosis - 1);
  const double of_y = std::max(0.0, y.kurtosis - 1) / allocation;
  if (of_x + of_y == 0) return 0;
  return slope(x, of_x / (of_x + of_y)) + slope(y, of_y / (of_x + of_y)) / std::sqrt(allocation);
}

std::uint64_t needed(double slope, double critical_value, double level_factor) {
  check::positive({"values_for_log_variance", "critical_value"}, critical_value);
  if (!(level_factor > 1)) {
    check::fail({"values_for_log_variance", "level_factor"}, level_factor, "above 1");
  }
  const double cube = critical_value * critical_value * critical_value;
  const double root = slope * cube / std::log(level_factor);
  const double count = std::ceil(root * root);
  if (!(count < 0x1p53))
    check::fail({"values_for_log_variance", "values needed"}, count, "below 2^53");
  return static_cast<std::uint64_t>(std::max(2.0, count));
}

}  // namespace

SixthOrderShape sixth_order_shape(std::span<const double> values) {
  check::at_least({"sixth_order_shape", "count"}, values.size(), 2);
  const double n = static_cast<double>(values.size());
  double mean = 0;
  for (const double value : values) mean += value / n;
  double sums[7] = {};
  for (const double value : values) {
    const double d = value - mean;
    double power = d;
    for (int r = 2; r <= 6; ++r) sums[r] += (power *= d);
  }
  check::finite({"sixth_order_shape", "sum of sixth powers"}, sums[6]);
  if (sums[2] == 0) throw ZeroVariance("sixth_order_shape: zero variance");
  const auto standardised = [&](int r) { return sums[r] / n / std::pow(sums[2] / n, r / 2.0); };
  return {.skewness = standardised(3),
          .kurtosis = standardised(4),
          .fifth = standardised(5),
          .sixth = standardised(6)};
}

SixthOrderShape averaged(const SixthOrderShape& shape, std::uint64_t count) {
  check::at_least({"averaged", "count"}, count, 1);
  const double m = static_cast<double>(count);
  // Cumulants of the standardised law from its moments, and back (mu_2 = 1).
  const double k3 = shape.skewness / std::sqrt(m);
  const double k4 = (shape.kurtosis - 3) / m;
  const double k5 = (shape.fifth - 10 * shape.skewness) / (m * std::sqrt(m));
  const double k6 =
      (shape.sixth - 15 * shape.kurtosis - 10 * shape.skewness * shape.skewness + 30) / (m * m);
  return {.skewness = k3,
          .kurtosis = k4 + 3,
          .fifth = k5 + 10 * k3,
          .sixth = k6 + 15 * k4 + 10 * k3 * k3 + 15};
}

std::uint64_t values_for_log_variance(const SixthOrderShape& x, double critical_value,
                                      double level_factor) {
  return needed(slope(x, 1), critical_value, level_factor);
}

std::uint64_t values_for_log_variance(const SixthOrderShape& x, const SixthOrderShape& y,
                                      double critical_value, double level_factor,
                                      double allocation) {
  check::positive({"values_for_log_variance", "allocation"}, allocation);
  return needed(slope_of_both(x, y, allocation), critical_value, level_factor);
}

std::uint64_t values_for_log_mean(PositiveShape x, double critical_value, double level_factor) {
  check::non_negative({"values_for_log_mean", "variation"}, x.variation);
  check::finite({"values_for_log_mean", "skewness"}, x.skewness);
  return needed(log_mean_slope(x).value, critical_value, level_factor);
}

LogMeanSlope log_mean_slope(PositiveShape x) { return slope(x, least_share_of_mean); }

}  // namespace assay::stats
