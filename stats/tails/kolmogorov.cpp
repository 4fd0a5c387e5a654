#include "stats/tails/kolmogorov.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/durbin.h"
#include "stats/tails/pelz_good.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

// ---- One-sided, Birnbaum & Tingey: d sum_j C(n, j) (d + j/n)^(j-1) (1 - d - j/n)^(n-j)

struct OneSidedTerm {
  double n;
  double d;

  // ln of term j without the leading d. In deviance form, with x = j/n, the powers and the binomial
  // coefficient are e^(-n KL(x || x + d)) up to Stirling's errors.
  double operator()(double j) const {
    const double x = j / n;
    const double up = x + d;
    const double down = 1 - up;
    if (j == 0) return n * std::log1p(-d) - std::log(d);
    if (!(down > 0)) return special::lowest_log();
    const double rest = n - j;
    const double binomial = special::stirling_error(n) - special::stirling_error(j) -
                            special::stirling_error(rest) -
                            0.5 * std::log(2 * std::numbers::pi * j * (rest / n));
    // Ratios are (j/n + d) / (j/n) and (1 - x - d) / (1 - x). Their linear parts n d cancel.
    return binomial + special::log_deviance(j, 1 + d / x) +
           special::log_deviance(rest, 1 - d / (1 - x)) - std::log(up);
  }
};

// From here on the sum takes every s-th term times s. The terms are a smooth function of j that
// vanishes with all derivatives at both ends. So it converges faster than any power.
constexpr double densest_sum = 4000;

double log_one_sided_sum(const OneSidedTerm& term, double last) {
  const double stride = last < 2 * densest_sum ? 1 : std::floor(last / densest_sum);
  std::vector<double> logs;
  logs.reserve(static_cast<std::size_t>(last / stride) + 1);
  for (double j = 0; j <= last; j += stride) logs.push_back(term(j));
  const double peak = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double value : logs) sum += std::exp(value - peak);
  return peak + std::log(sum * stride);
}

// ---- Two-sided

// P(D >= d) = 2 P(D+ >= d) - P(both sides cross). To the leading order in 1/n the second is 2 e^(-8
// z^2) - 2 e^(-18 z^2). Here z = sqrt(n) d + 1 / (6 sqrt n), Pelz & Good's shift.
double log_upper_from_one_sided(double d, std::uint64_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double z = root * d + 1 / (6 * root);
  const double one = std::numbers::ln2 + log_smirnov_one_sided(d, n);
  const double both = std::numbers::ln2 - 8 * z * z + std::log1p(-std::exp(-10 * z * z));
  return d >= 0.5 ? one : one + std::log1p(-std::exp(both - one));
}

// Bounds between the forms; n d^2 is the square of the limit law's argument. The corrected upper
// tail is within 2e-9 relative of Durbin's matrix from n d^2 = 3 on for n > 500. From 4 on it is
// within 2e-10 for every n. The expansion is within 4e-9 where the matrix is not used (10 ms at n d
// = 60).
double upper_tail_from(std::uint64_t n) { return n <= 500 ? 4 : 3; }

bool durbin_affordable(double d, std::uint64_t n) {
  return n <= 100000 && static_cast<double>(n) * d <= 60;
}

enum class Body { exact, expansion };

LogTails body(double d, std::uint64_t n, Body by) {
  if (by == Body::exact && durbin_affordable(d, n)) {
    return special::from_lower(log_durbin_lower(d, n));
  }
  return special::from_lower(std::log(pelz_good_lower(d, n)));
}

LogTails tails_by(Body by, double distance, std::uint64_t n) {
  const double size = static_cast<double>(n);
  const double t = size * distance;
  if (t <= 0.5) return special::from_lower(special::lowest_log());
  if (distance == 1) return special::from_upper(special::lowest_log());
  // n! ((2 t - 1) / n)^n.
  if (t <= 1) {
    return special::from_lower(std::lgamma(size + 1) + size * std::log((2 * t - 1) / size));
  }
  if (distance >= 0.5 || t * distance >= upper_tail_from(n)) {
    return special::from_upper(log_upper_from_one_sided(distance, n));
  }
  return body(distance, n, by);
}

/// The upper end of the bracket in which ln P(D >= d), computed by this form, falls to
/// log_probability.
double solve_quantile(Body by, double log_probability, std::uint64_t n, double low, double high) {
  const auto excess = [&](double d) { return log_probability - tails_by(by, d, n).upper; };
  std::uintmax_t iterations = 100;
  return boost::math::tools::toms748_solve(
             excess, low, high, boost::math::tools::eps_tolerance<double>(44), iterations)
      .second;
}

}  // namespace

double log_smirnov_one_sided(double distance, std::uint64_t n) {
  check::at_least({"log_smirnov_one_sided", "n"}, n, 1);
  check::unit({"log_smirnov_one_sided", "distance"}, distance);
  if (distance == 0) return 0;
  if (distance == 1) return special::lowest_log();
  const double size = static_cast<double>(n);
  const double last = std::floor(size * (1 - distance));
  const double log_sum = log_one_sided_sum({size, distance}, std::min(last, size - 1));
  return special::clamp_log(std::log(distance) + log_sum);
}

double log_kolmogorov_limit(double z) {
  if (!(z >= 0)) check::fail({"log_kolmogorov_limit", "z"}, z, "at least 0");
  if (z < 1) {
    // Jacobi's dual series for the lower tail: sqrt(2 pi) / z sum e^(-(2k-1)^2 pi^2 / (8 z^2)).
    if (z < 0.04) return 0;
    const double q = -std::numbers::pi * std::numbers::pi / (8 * z * z);
    const double sum = std::exp(q) + std::exp(9 * q) + std::exp(25 * q);
    return std::log1p(-std::sqrt(2 * std::numbers::pi) / z * sum);
  }
  const double square = z * z;
  const double rest = -std::exp(-6 * square) + std::exp(-16 * square) - std::exp(-30 * square);
  return std::max(std::numbers::ln2 - 2 * square + std::log1p(rest), special::lowest_log());
}

LogTails kolmogorov_tails(double distance, std::uint64_t n) {
  check::at_least({"kolmogorov_tails", "n"}, n, 1);
  check::unit({"kolmogorov_tails", "distance"}, distance);
  return tails_by(Body::exact, distance, n);
}

double kolmogorov_upper_quantile(double log_probability, std::uint64_t n) {
  check::at_least({"kolmogorov_upper_quantile", "n"}, n, 1);
  if (!(log_probability < 0) || std::isinf(log_probability)) {
    check::fail({"kolmogorov_upper_quantile", "log_probability"}, log_probability, "below 0");
  }
  const double size = static_cast<double>(n);
  // Massart's bound 2 e^(-2 n d^2) lies above the law, so the quantile is at most its inverse.
  const double bound = std::sqrt((std::numbers::ln2 - log_probability) / (2 * size));
  const double highest = std::min(1.0, bound * (1 + 1e-12));
  const double lowest = 0.5 / size;
  // The expansion finds the place and the slope in microseconds. The matrix takes milliseconds and
  // is asked about twice.
  double near = solve_quantile(Body::expansion, log_probability, n, lowest, highest);
  const double other = near * (1 - 1e-4);
  const double slope =
      (tails_by(Body::expansion, other, n).upper - tails_by(Body::expansion, near, n).upper) /
      (other - near);
  for (int i = 0; i < 10 && slope < 0; ++i) {
    const double step = (log_probability - kolmogorov_tails(near, n).upper) / slope;
    near = std::clamp(near + step, lowest, highest);
    // The matrix gives a p-value of .01 to 1e-12, so no closer is needed. The upper side is the
    // conservative one.
    if (std::abs(step) <= 0x1p-38 * near) return std::min(near * (1 + 0x1p-38), highest);
  }
  return solve_quantile(Body::exact, log_probability, n, lowest, highest);
}

}  // namespace assay::stats
