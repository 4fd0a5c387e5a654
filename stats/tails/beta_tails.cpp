#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/basics/convergents.h"
#include "stats/tails/special.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

namespace policies = boost::math::policies;
using Quiet = policies::policy<policies::overflow_error<policies::ignore_error>,
                               policies::evaluation_error<policies::ignore_error>,
                               policies::promote_double<false>>;
using special::BetaPoint;

constexpr double boost_minimum = 1e-280;
// The fraction takes about sqrt(min(alpha, beta)) terms near the mean, 70 at this bound.
constexpr double most_for_fraction = 1e4;

// The fraction 1 / (b0 + a1 / (b1 + a2 / (b2 + …))) of Didonato & Morris (1992), equation 9. It
// takes two steps of DLMF 8.17.22 in one. Its convergents divide only where they are compared.
//   A_n = b_n A_(n-1) + a_n A_(n-2), B_n likewise.
double beta_fraction(BetaPoint point, BetaShape shape) {
  const auto [a, b] = shape;
  const auto [x, y] = point;
  const double lambda = a * y - b * x;
  double reciprocal = 1 / (a + 1);
  special::Convergents fraction{.now = a * (lambda + 1) * reciprocal};
  double last = 0;
  for (double n = 1; n < 1e5;) {
    for (const double end = n + 4; n < end; ++n) {
      const double next = 1 / (a + 2 * n + 1);
      const double r = x * reciprocal;
      const double left = n * (b - n) * r;
      const double numerator = (a + n - 1) * (a + b + n - 1) * left * r;
      const double denominator = n + left + (a + n) * (lambda + 1 + n * (1 + y)) * next;
      fraction.add(numerator, denominator);
      reciprocal = next;
    }
    const double value = fraction.reciprocal();
    if (std::abs(value - last) <= 1e-12 * value) return value;
    last = value;
  }
  return last;
}

double log_by_fraction(BetaPoint point, BetaShape shape) {
  return special::log_beta_prefix(shape, point) + std::log(beta_fraction(point, shape));
}

// ln I_x(a, b) for x at or below the mean.
double log_lower(BetaPoint point, BetaShape shape) {
  if (point.x == 0) return special::lowest_log();
  if (std::min(shape.alpha, shape.beta) <= most_for_fraction) return log_by_fraction(point, shape);
  const double p = point.x <= 0.5 ? boost::math::ibeta(shape.alpha, shape.beta, point.x, Quiet())
                                  : boost::math::ibetac(shape.beta, shape.alpha, point.y, Quiet());
  return p > boost_minimum ? std::log(p) : log_by_fraction(point, shape);
}

void check_binomial(std::uint64_t successes, Trials trials) {
  check::at_least({"binomial_tails", "trials"}, trials.trials, 1);
  check::unit({"binomial_tails", "probability"}, trials.probability);
  if (successes > trials.trials) {
    check::fail({"binomial_tails", "successes"}, successes, "at most trials");
  }
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

namespace {

// P(|T| < t) = x^a y^b / (a B(a, b)) (1 + sum of (a+b)_n / (a+1)_n x^n). Here x = t^2 / (nu + t^2),
// a = 1/2, b = nu/2; DLMF 8.17.8. Positive terms, about t^2 / 2 times the one before over n.
double central_student_t(BetaPoint point, double degrees) {
  const BetaShape shape{0.5, degrees / 2};
  double term = 1;
  double sum = 1;
  for (double n = 0; term > 1e-16 * sum; ++n) {
    term *= point.x * ((0.5 + shape.beta + n) / (1.5 + n));
    sum += term;
  }
  return 2 * std::exp(special::log_beta_prefix(shape, point)) * sum;
}

// Up to here, and to nu, either tail is above .02. One minus the middle then costs no promised
// digit. Beyond, the fraction takes fewer terms than the series.
constexpr double most_central_square = 4;

}  // namespace

LogTails student_t_tails(double t, double degrees) {
  check::positive({"student_t_tails", "degrees"}, degrees);
  check::finite({"student_t_tails", "t"}, t);
  // From here on the laws agree to 1e-10 in p >= 1e-300 (t <= 37). Also, 1e18 + t^2 would absorb
  // t^2.
  if (degrees > 1e18) return normal_tails(t);
  // t^2 must not overflow.
  const double magnitude = std::min(std::abs(t), 1e150);
  const double square = magnitude * magnitude;
  const double sum = degrees + square;
  if (square == 0) return {-std::numbers::ln2, -std::numbers::ln2};
  if (square <= std::min(most_central_square, degrees)) {
    const double middle = central_student_t({square / sum, degrees / sum}, degrees);
    const double outer = std::log1p(-middle) - std::numbers::ln2;
    const double inner = std::log1p(middle) - std::numbers::ln2;
    return t >= 0 ? LogTails{inner, outer} : LogTails{outer, inner};
  }
  // P(|T| >= |t|) = I_x(nu / 2, 1 / 2) at x = nu / (nu + t^2)
  const LogTails both = special::beta_tails_at({degrees / sum, square / sum}, {degrees / 2, 0.5});
  const double outer = halved(both).lower;
  return t >= 0 ? special::from_upper(outer) : special::from_lower(outer);
}

double binomial_lower(std::uint64_t successes, Trials trials) {
  check_binomial(successes, trials);
  if (successes == trials.trials) return 0;
  const double k = static_cast<double>(successes);
  return beta_tails(trials.probability, {k + 1, static_cast<double>(trials.trials) - k}).upper;
}

double binomial_upper(std::uint64_t successes, Trials trials) {
  check_binomial(successes, trials);
  if (successes == 0) return 0;
  const double k = static_cast<double>(successes);
  return beta_tails(trials.probability, {k, static_cast<double>(trials.trials) - k + 1}).lower;
}

LogTails binomial_tails(std::uint64_t successes, Trials trials) {
  return {binomial_lower(successes, trials), binomial_upper(successes, trials)};
}

}  // namespace assay::stats
