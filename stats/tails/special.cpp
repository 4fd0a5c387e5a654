#include "stats/tails/special.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace assay::stats {

double log_complement(double log_probability) {
  return log_probability > -std::numbers::ln2 ? std::log(-std::expm1(log_probability))
                                              : std::log1p(-std::exp(log_probability));
}

double log_sum(double a, double b) {
  const auto [low, high] = std::minmax(a, b);
  if (std::isinf(high)) return high;
  return high + std::log1p(std::exp(low - high));
}

namespace special {

double log_sum_of(std::span<const double> logs) {
  const double largest = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double value : logs) sum += std::exp(value - largest);
  return largest + std::log(sum);
}

double lowest_log() { return std::numeric_limits<double>::lowest(); }

double clamp_log(double log_probability) { return std::clamp(log_probability, lowest_log(), 0.0); }

LogTails from_lower(double log_lower) {
  return {clamp_log(log_lower), clamp_log(log_complement(std::min(log_lower, 0.0)))};
}

LogTails from_upper(double log_upper) {
  return {clamp_log(log_complement(std::min(log_upper, 0.0))), clamp_log(log_upper)};
}

double stirling_error(double z) {
  constexpr double half_log_two_pi = 0.91893853320467274178;
  if (z == 0.5) return 0.5 - std::numbers::ln2 / 2;  // Student's t asks for it every time.
  if (z < 8) return std::lgamma(z) - ((z - 0.5) * std::log(z) - z + half_log_two_pi);
  // Asymptotic series with Bernoulli numbers; the first term left out is below 1e-16 at z = 8.
  const double w = 1 / (z * z);
  return (1 / 12.0 -
          w * (1 / 360.0 -
               w * (1 / 1260.0 -
                    w * (1 / 1680.0 -
                         w * (1 / 1188.0 -
                              w * (691 / 360360.0 - w * (1 / 156.0 - w * (3617 / 122400.0)))))))) /
         z;
}

double log1p_minus(double z) {
  // Half a digit is lost at .15.
  if (std::abs(z) > 0.15) return std::log1p(z) - z;
  // With r = z / (2 + z), ln(1 + z) = 2 atanh r and z = 2 r / (1 - r). Their difference is -r z + 2
  // r^3 (1/3 + r^2/5 + r^4/7 + …), with a smaller second part.
  const double r = z / (2 + z);
  const double w = r * r;
  const double sum =
      1 / 3.0 +
      w * (1 / 5.0 +
           w * (1 / 7.0 +
                w * (1 / 9.0 + w * (1 / 11.0 + w * (1 / 13.0 + w * (1 / 15.0 + w / 17.0))))));
  return r * (2 * w * sum - z);
}

double log_deviance(double weight, double ratio) {
  const double excess = ratio - 1;
  if (std::abs(excess) < 0.15) return weight * log1p_minus(excess);
  return weight * (std::log(ratio) - excess);
}

double log_gamma_prefix(double shape, double x, double factor) {
  return log_deviance(shape, x / shape) +
         std::log(factor * std::sqrt(shape / (2 * std::numbers::pi))) - stirling_error(shape);
}

double log_beta_prefix(BetaShape shape, BetaPoint point) {
  const auto [a, b] = shape;
  const double sum = a + b;
  return log_deviance(a, point.x * (sum / a)) + log_deviance(b, point.y * (sum / b)) +
         0.5 * std::log(a / sum * b / (2 * std::numbers::pi)) + stirling_error(sum) -
         stirling_error(a) - stirling_error(b);
}

}  // namespace special
}  // namespace assay::stats
