#include "stats/laws/anderson_darling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "stats/basics/check.h"

namespace assay::stats {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double largest_double = std::numeric_limits<double>::max();

// One term of the series times e^x, by Chebyshev's rule. With v = w - 4k = cos(phi) the weight 1 /
// sqrt(1 - v^2) cancels the ends' singularities. So the rule converges geometrically.
double series_term(int k, double x) {
  // The factor e^(-3 x (w - 3) / 4) must be resolved at the edge of the first interval.
  const int nodes = 40 + static_cast<int>(8 * std::sqrt(x));
  double sum = 0;
  for (int i = 1; i <= nodes; ++i) {
    const double phi = (2 * i - 1) * pi / (2 * nodes);
    const double w = 4 * k + std::cos(phi);
    const double y = (w * w - 1) / 4;
    // cos(pi v / 2) = sin(pi (1 - |v|) / 2), 1 - |v| without cancellation.
    const double half = phi < pi / 2 ? std::sin(phi / 2) : std::cos(phi / 2);
    const double edge = std::sin(pi * half * half);
    sum += std::exp(-x * (y / 2 - 1)) * (w / 2) * std::sqrt(pi / y / edge) * std::sin(phi);
  }
  return sum / nodes;
}

double log_limit_upper(double x) {
  // Below this the law has less than 1e-26.
  if (x < 0.02) return 0;
  // Laplace's value of the first term at that edge, relative error .2 / x.
  if (x > 1e6) return std::log(1.5) - std::log(0.75 * pi * x) / 2 - x;
  double sum = 0;
  for (int k = 1;; ++k) {
    const double term = series_term(k, x);
    sum += k % 2 == 1 ? term : -term;
    if (term < 1e-17 * sum) break;
  }
  return std::min(0.0, std::log(sum) - x);
}

// A2 with u_i moved towards (2i - 1) / 2n by `error` at most.
double least_statistic(std::span<const double> given, double error) {
  const std::size_t n = given.size();
  check::at_least({"anderson_darling", "values"}, n, 5);
  const double size = static_cast<double>(n);
  std::vector<double> u;
  u.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    check::unit({"anderson_darling", "cdf"}, given[i]);
    const double bottom = (2 * static_cast<double>(i) + 1) / (2 * size);
    u.push_back(std::clamp(bottom, given[i] - error, given[i] + error));
  }
  const auto [lowest, highest] = std::minmax_element(u.begin(), u.end());
  if (*lowest <= 0 || *highest >= 1) return largest_double;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += static_cast<double>(2 * i + 1) * (std::log(u[i]) + std::log1p(-u[n - 1 - i]));
  }
  return -size - sum / size;
}

}  // namespace

double log_anderson_darling_upper(double x, std::uint64_t n) {
  check::at_least({"log_anderson_darling_upper", "n"}, n, 5);
  check::finite({"log_anderson_darling_upper", "x"}, x);
  const double correction = std::max(0.0, (x - 1) / 5) / static_cast<double>(n);
  return std::max(std::min(0.0, log_limit_upper(x) + std::log1p(correction)),
                  std::numeric_limits<double>::lowest());
}

TestResult anderson_darling(Probabilities at, double error) {
  check::non_negative({"anderson_darling", "error"}, error);
  const double statistic = least_statistic(at.of_values, error);
  return {statistic,
          {"bound", {}},
          0,
          log_anderson_darling_upper(statistic, at.of_values.size()),
          Exactness::asymptotic};
}

}  // namespace assay::stats
