#include "stats/tails/tails.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <limits>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/basics/search.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

namespace policies = boost::math::policies;
using Quiet = policies::policy<policies::overflow_error<policies::ignore_error>,
                               policies::evaluation_error<policies::ignore_error>,
                               policies::promote_double<false>>;
using special::BetaPoint;

// Below this Boost's result may be denormal. The log forms take over long before.
constexpr double boost_minimum = 1e-280;

// A continued fraction b_0 + a_1 / (b_1 + a_2 / (b_2 + ...)). The recurrence of its convergents
// A_n / B_n needs no division a term: A_n = b_n A_(n-1) + a_n A_(n-2), B_n likewise.
struct Convergents {
  double before = 1;
  double now = 1;  // A_n
  double inverse_before = 0;
  double inverse_now = 1;  // B_n

  // Takes the term a_n / b_n.
  void add(double numerator, double denominator) {
    const double later = denominator * now + numerator * before;
    const double inverse_later = denominator * inverse_now + numerator * inverse_before;
    before = now;
    inverse_before = inverse_now;
    now = later;
    inverse_now = inverse_later;
  }

  // One over the fraction so far, B_n / A_n. Rescales, so that nothing overflows.
  double reciprocal() {
    const double scale = 1 / now;
    before *= scale;
    inverse_before *= scale;
    inverse_now *= scale;
    now = 1;
    return inverse_now;
  }

  // One over the whole fraction, of which term(n) gives a_n and b_n from n = 1 on. It takes four
  // terms at a time, and fewer than `most`.
  template <class Term>
  double reciprocal_of_all(double most, const Term& term) {
    double last = 0;
    for (double n = 1; n < most;) {
      for (const double end = n + 4; n < end; ++n) {
        const auto [numerator, denominator] = term(n);
        add(numerator, denominator);
      }
      const double value = reciprocal();
      if (std::abs(value - last) <= 1e-12 * value) return value;
      last = value;
    }
    return last;
  }
};

// ---- Normal

// ln P(X >= x) for x >= 30 from Laplace's continued fraction of Mills' ratio (DLMF 7.9.2). Forty
// terms reach full precision there.
double log_far_upper(double x) {
  constexpr double half_log_two_pi = 0.91893853320467274178;
  double fraction = x;
  for (int k = 40; k >= 1; --k) fraction = x + k / fraction;
  return -0.5 * x * x - half_log_two_pi - std::log(fraction);
}

double log_upper(double x) {
  return x < 30 ? std::log(0.5 * std::erfc(x / std::numbers::sqrt2)) : log_far_upper(x);
}

// ---- Gamma

// ln P(a, x) = prefix - ln a + ln sum x^k / ((a+1) … (a+k)); DLMF 8.7.1. It takes four terms at a
// time, whose factors do not wait for one another.
double log_far_lower(double shape, double x) {
  double term = 1;
  double sum = 1;
  for (double k = shape; term > sum * 1e-15; k += 4) {
    const double first = x / (k + 1);
    const double second = first * (x / (k + 2));
    const double third = x / (k + 3);
    const double fourth = third * (x / (k + 4));
    sum += term * (first + second + second * (third + fourth));
    term *= second * fourth;
  }
  return special::log_gamma_prefix(shape, x, sum / shape);
}

// ln Q(a, x) by Legendre's continued fraction, DLMF 8.9.2, divided by b_0, which may be huge.
double log_far_upper(double shape, double x) {
  const double per_first = 1 / (x + 1 - shape);
  Convergents fraction{.inverse_now = per_first};
  const double value = fraction.reciprocal_of_all(1e7, [&](double k) {
    return std::pair(k * per_first * ((shape - k) * per_first), 1 + 2 * k * per_first);
  });
  return special::log_gamma_prefix(shape, x, value);
}

// Up to here the sum and the fraction take at most 200 terms and are cheaper than Boost's
// expansion.
constexpr double most_for_sum = 2000;

double log_upper(double shape, double x) {
  if (shape <= most_for_sum) return log_far_upper(shape, x);
  const double q = boost::math::gamma_q(shape, x, Quiet());
  return q > boost_minimum ? std::log(q) : log_far_upper(shape, x);
}

double log_lower(double shape, double x) {
  if (x == 0) return special::lowest_log();
  if (shape <= most_for_sum) return log_far_lower(shape, x);
  const double p = boost::math::gamma_p(shape, x, Quiet());
  return p > boost_minimum ? std::log(p) : log_far_lower(shape, x);
}

// ---- Beta

// The fraction takes about sqrt(min(alpha, beta)) terms near the mean, 70 at this bound.
constexpr double most_for_fraction = 1e4;

// By the fraction 1 / (b0 + a1 / (b1 + a2 / (b2 + …))) of Didonato & Morris (1992), equation 9. It
// takes two steps of DLMF 8.17.22 in one.
double log_by_fraction(BetaPoint point, BetaShape shape) {
  const auto [a, b] = shape;
  const auto [x, y] = point;
  const double lambda = a * y - b * x;
  double reciprocal = 1 / (a + 1);
  Convergents fraction{.now = a * (lambda + 1) * reciprocal};
  const double value = fraction.reciprocal_of_all(1e5, [&](double n) {
    const double next = 1 / (a + 2 * n + 1);
    const double r = x * reciprocal;
    const double left = n * (b - n) * r;
    const double numerator = (a + n - 1) * (a + b + n - 1) * left * r;
    const double denominator = n + left + (a + n) * (lambda + 1 + n * (1 + y)) * next;
    reciprocal = next;
    return std::pair(numerator, denominator);
  });
  return special::log_beta_prefix(shape, point) + std::log(value);
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

TestResult without_error(double difference, const char* law) {
  const double impossible = special::lowest_log();
  return {difference, {law, {}}, difference < 0 ? impossible : 0, difference > 0 ? impossible : 0};
}

double log_p_two_sided(LogTails tails) {
  return std::min(0.0, std::numbers::ln2 + std::min(tails.lower, tails.upper));
}

double log_p_two_sided(const TestResult& result) {
  return log_p_two_sided(LogTails{result.log_p_lower, result.log_p_upper});
}

double log_p_equivalence(const TestResult& at_low, const TestResult& at_high) {
  return std::max(at_low.log_p_upper, at_high.log_p_lower);
}

LogTails normal_tails(double x) {
  check::finite({"normal_tails", "x"}, x);
  return x >= 0 ? special::from_upper(log_upper(x)) : special::from_lower(log_upper(-x));
}

double normal_upper(double x) {
  check::finite({"normal_upper", "x"}, x);
  return x >= 0 ? special::clamp_log(log_upper(x)) : special::from_lower(log_upper(-x)).upper;
}

LogTails gamma_tails(double x, double shape) {
  check::positive({"gamma_tails", "shape"}, shape);
  check::finite({"gamma_tails", "x"}, x);
  if (x <= 0) return special::from_lower(special::lowest_log());
  return x >= shape ? special::from_upper(log_upper(shape, x))
                    : special::from_lower(log_lower(shape, x));
}

LogTails chi_square_tails(double x, double degrees) {
  check::positive({"chi_square_tails", "degrees"}, degrees);
  check::finite({"chi_square_tails", "x"}, x);
  return gamma_tails(x / 2, degrees / 2);
}

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
  const double outer = both.lower - std::numbers::ln2;
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

namespace {

constexpr int most_doublings = 60;
constexpr unsigned digits_of_reach = 40;

// The end in one direction of the values at which a curve is positive.
double end_of(const Curve& curve, const Whereabouts& around, double direction) {
  const auto at = [&](double reach) { return curve(around.estimate + direction * reach); };
  double inside = 0;
  double outside = around.step;
  for (int doublings = 0; at(outside) > 0; outside *= 2) {
    inside = outside;
    if (++doublings == most_doublings) return direction * std::numeric_limits<double>::infinity();
  }
  // Rounding may move the end of a tiny step to its other side.
  if (!(at(inside) > 0) || at(outside) > 0) return around.estimate;
  return around.estimate + direction * root_bracket(at, inside, outside, digits_of_reach).first;
}

}  // namespace

Interval interval_by_inversion(const std::function<TestResult(double)>& at,
                               const Whereabouts& around, double confidence) {
  check::inside_unit({"interval_by_inversion", "confidence"}, confidence);
  const double level = std::log((1 - confidence) / 2);
  const auto above = [&](double theta) { return at(theta).log_p_lower - level; };
  const auto below = [&](double theta) { return at(theta).log_p_upper - level; };
  return {end_of(below, around, -1), end_of(above, around, 1), confidence};
}

}  // namespace assay::stats
