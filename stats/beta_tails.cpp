#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "stats/check.h"
#include "stats/special.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

namespace policies = boost::math::policies;
using Quiet = policies::policy<policies::overflow_error<policies::ignore_error>,
                               policies::evaluation_error<policies::ignore_error>,
                               policies::promote_double<false>>;
using special::BetaPoint;

constexpr double boost_minimum = 1e-280;

// Coefficient k of the continued fraction of I_x(a, b), DLMF 8.17.22.
double coefficient(double k, BetaShape shape, double x) {
  const auto [a, b] = shape;
  const double m = std::floor(k / 2);
  if (2 * m == k) return m * (b - m) * x / ((a + k - 1) * (a + k));
  return -(a + m) * (a + b + m) * x / ((a + k - 1) * (a + k));
}

// ln I_x(a, b) far below the mean, where the continued fraction converges fast (Lentz's method).
double log_far_lower(BetaPoint point, BetaShape shape) {
  double c = std::numeric_limits<double>::max();
  double d = 1;
  double fraction = 1;
  for (double k = 1; k < 1e7; ++k) {
    const double e = coefficient(k, shape, point.x);
    d = 1 / (1 + e * d);
    c = 1 + e / c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-16) break;
  }
  return special::log_beta_prefix(shape, point) - std::log(shape.alpha) + std::log(fraction);
}

// ln I_x(a, b) for x at or below the mean.
double log_lower(BetaPoint point, BetaShape shape) {
  if (point.x == 0) return special::lowest_log();
  const double p = point.x <= 0.5 ? boost::math::ibeta(shape.alpha, shape.beta, point.x, Quiet())
                                  : boost::math::ibetac(shape.beta, shape.alpha, point.y, Quiet());
  return p > boost_minimum ? std::log(p) : log_far_lower(point, shape);
}

LogTails halved(LogTails tails) {
  return {tails.lower - std::numbers::ln2, tails.upper - std::numbers::ln2};
}

}  // namespace

LogTails special::beta_tails_at(BetaPoint point, BetaShape shape) {
  const bool below = point.x * shape.beta <= point.y * shape.alpha;
  return below ? from_lower(log_lower(point, shape))
               : from_upper(log_lower({point.y, point.x}, {shape.beta, shape.alpha}));
}

LogTails beta_tails(double x, BetaShape shape) {
  check::positive({"beta_tails", "alpha"}, shape.alpha);
  check::positive({"beta_tails", "beta"}, shape.beta);
  check::unit({"beta_tails", "x"}, x);
  return special::beta_tails_at({x, 1 - x}, shape);
}

LogTails f_tails(double f, FDegrees degrees) {
  check::positive({"f_tails", "numerator degrees"}, degrees.numerator);
  check::positive({"f_tails", "denominator degrees"}, degrees.denominator);
  check::finite({"f_tails", "f"}, f);
  if (f <= 0) return special::from_lower(special::lowest_log());
  const double odds = f * (degrees.numerator / degrees.denominator);
  const BetaPoint point = odds < 1 ? BetaPoint{odds / (1 + odds), 1 / (1 + odds)}
                                   : BetaPoint{1 / (1 + 1 / odds), 1 / odds / (1 + 1 / odds)};
  return special::beta_tails_at(point, {degrees.numerator / 2, degrees.denominator / 2});
}

LogTails student_t_tails(double t, double degrees) {
  check::positive({"student_t_tails", "degrees"}, degrees);
  check::finite({"student_t_tails", "t"}, t);
  // The laws agree to 1e-10 in p >= 1e-300 (t <= 37) from here on, and 1e18 + t^2 would absorb t^2.
  if (degrees > 1e18) return normal_tails(t);
  const double magnitude = std::min(std::abs(t), 1e150);  // t^2 must not overflow
  const double square = magnitude * magnitude;
  const double sum = degrees + square;
  // P(|T| >= |t|) = I_x(nu / 2, 1 / 2) at x = nu / (nu + t^2)
  const LogTails both = special::beta_tails_at({degrees / sum, square / sum}, {degrees / 2, 0.5});
  const double outer = halved(both).lower;
  return t >= 0 ? special::from_upper(outer) : special::from_lower(outer);
}

LogTails binomial_tails(std::uint64_t successes, Trials trials) {
  const auto [n, p] = trials;
  check::at_least({"binomial_tails", "trials"}, n, 1);
  check::unit({"binomial_tails", "probability"}, p);
  if (successes > n) check::fail({"binomial_tails", "successes"}, successes, "at most trials");
  const double k = static_cast<double>(successes);
  const double size = static_cast<double>(n);
  LogTails tails;
  if (successes < n) tails.lower = beta_tails(p, {k + 1, size - k}).upper;
  if (successes > 0) tails.upper = beta_tails(p, {k, size - k + 1}).lower;
  return tails;
}

}  // namespace assay::stats
