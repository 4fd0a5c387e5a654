#include "stats/tails/smirnov.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/kolmogorov.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

constexpr double largest_lattice = 1e8;

// ---- m = n: P = 2 sum_i (-1)^(i-1) C(2n, n - i k) / C(2n, n)

// ln C(2n, n - r) / C(2n, n), in deviance form: absolute error of a few ulps of the result.
double log_relative_binomial(double n, double r) {
  if (r == n) return 2 * std::lgamma(n + 1) - std::lgamma(2 * n + 1);
  const double up = n + r;
  const double down = n - r;
  return 2 * special::stirling_error(n) - special::stirling_error(up) -
         special::stirling_error(down) - 0.5 * (std::log1p(r / n) + std::log1p(-r / n)) +
         special::log_deviance(up, n / up) + special::log_deviance(down, n / down);
}

// Nested: A_1 (1 - A_2/A_1 (1 - A_3/A_2 (…))).
double log_equal_sizes(std::uint64_t steps, std::uint64_t n) {
  const double size = static_cast<double>(n);
  const double k = static_cast<double>(steps);
  const double first = log_relative_binomial(size, k);
  double nested = 1;
  // Terms below e^-50 of the first change nothing.
  double last = 1;
  while ((last + 1) * k <= size && log_relative_binomial(size, (last + 1) * k) > first - 50) ++last;
  for (double i = last; i > 1; --i) {
    const double ratio =
        std::exp(log_relative_binomial(size, i * k) - log_relative_binomial(size, (i - 1) * k));
    nested = 1 - ratio * nested;
  }
  return std::numbers::ln2 + first + std::log(nested);
}

// ---- m != n: v(i, j) = P(a path to (i, j) has touched the boundary)

// The result is 1 outside |i/m - j/n| < d, else (i v(i-1, j) + j v(i, j-1)) / (i + j). Only sums of
// positive terms. `Real` holds `one` in place of 1, so that the smallest path probability is in
// range.
template <class Real>
Real touching_probability(const LatticeDistance& distance, Real one) {
  const std::uint64_t common = std::gcd(distance.m, distance.n);
  const auto row_step = static_cast<std::int64_t>(distance.n / common);
  const auto column_step = static_cast<std::int64_t>(distance.m / common);
  const auto bound = static_cast<std::int64_t>(distance.steps);
  std::vector<Real> row(distance.n + 1, one);
  // A table of reciprocals keeps the division out of the chain from one column to the next.
  std::vector<Real> reciprocal(distance.m + distance.n + 1, Real{0});
  for (std::size_t k = 1; k < reciprocal.size(); ++k) reciprocal[k] = 1 / static_cast<Real>(k);
  for (std::uint64_t i = 0; i <= distance.m; ++i) {
    const std::int64_t gap = static_cast<std::int64_t>(i) * row_step;
    // Columns with |gap - j column_step| < bound. The band only moves to higher columns. Beyond it
    // `row` is still 1, and columns left behind are not read again.
    const std::int64_t below = gap - bound;
    const auto first = static_cast<std::uint64_t>(below < 0 ? 0 : below / column_step + 1);
    const auto last =
        std::min(static_cast<std::uint64_t>((gap + bound - 1) / column_step), distance.n);
    Real left = first == 0 ? Real{0} : one;
    for (std::uint64_t j = first; j <= last; ++j) {
      const Real weight = reciprocal[i + j];
      left = static_cast<Real>(i) * weight * row[j] + static_cast<Real>(j) * weight * left;
      row[j] = left;
    }
  }
  return row[distance.n];
}

double log_lattice(const LatticeDistance& distance) {
  const double m = static_cast<double>(distance.m);
  const double n = static_cast<double>(distance.n);
  // The limit law tells if a double will do. Denormal numbers would be slow as well as wrong.
  const double expected = log_kolmogorov_limit(std::sqrt(m / (m + n) * n) * distance.value());
  if (expected > -400) {
    const double p = touching_probability<double>(distance, 1.0);
    if (p > 1e-250) return std::log(p);
  }
  // C(m + n, m) is below 2^20001 for m n <= 1e8. (With m or n = 1 no p is small.) With 1 raised to
  // 2^16000 a long double's range covers it.
  constexpr int raised = 16000;
  const long double q = touching_probability<long double>(distance, std::ldexp(1.0L, raised));
  return static_cast<double>(std::log(q) - raised * std::numbers::ln2_v<long double>);
}

}  // namespace

double LatticeDistance::value() const {
  const double common = static_cast<double>(std::gcd(m, n));
  return static_cast<double>(steps) * (common / static_cast<double>(m)) / static_cast<double>(n);
}

SmirnovTail smirnov_upper_tail(LatticeDistance distance) {
  check::at_least({"smirnov_upper_tail", "m"}, distance.m, 1);
  check::at_least({"smirnov_upper_tail", "n"}, distance.n, 1);
  const double m = static_cast<double>(distance.m);
  const double n = static_cast<double>(distance.n);
  const std::uint64_t common = std::gcd(distance.m, distance.n);
  if (m / static_cast<double>(common) * n > 0x1p62) {
    check::fail({"smirnov_upper_tail", "lcm(m, n)"}, m / static_cast<double>(common) * n,
                "at most 2^62");
  }
  if (distance.steps == 0) return {0, Exactness::exact};
  if (distance.steps > distance.m / common * distance.n) {
    return {special::lowest_log(), Exactness::exact};
  }
  if (distance.m == distance.n) {
    return {special::clamp_log(log_equal_sizes(distance.steps, distance.n)), Exactness::exact};
  }
  if (m * n <= largest_lattice) {
    return {special::clamp_log(log_lattice(distance)), Exactness::exact};
  }
  const double z = std::sqrt(m / (m + n) * n) * distance.value();
  return {log_kolmogorov_limit(z), Exactness::asymptotic};
}

}  // namespace assay::stats
