#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

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

// Below this Boost's result may be denormal. The log forms take over long before.
constexpr double boost_gamma_minimum = 1e-280;

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

// ln Q(a, x) by Legendre's continued fraction, DLMF 8.9.2. The recurrence of its convergents
// divides only where they are compared. All is divided by b_0, which may be huge.
double log_far_upper(double shape, double x) {
  const double per_first = 1 / (x + 1 - shape);
  special::Convergents fraction{.inverse_now = per_first};
  double last = 0;
  for (double k = 1; k < 1e7;) {
    for (const double end = k + 4; k < end; ++k) {
      const double numerator = k * per_first * ((shape - k) * per_first);
      const double denominator = 1 + 2 * k * per_first;
      fraction.add(numerator, denominator);
    }
    const double value = fraction.reciprocal();
    if (std::abs(value - last) <= 1e-12 * value) return special::log_gamma_prefix(shape, x, value);
    last = value;
  }
  return special::log_gamma_prefix(shape, x, last);
}

// Up to here the sum and the fraction take at most 200 terms and are cheaper than Boost's
// expansion.
constexpr double most_for_sum = 2000;

double log_upper(double shape, double x) {
  if (shape <= most_for_sum) return log_far_upper(shape, x);
  const double q = boost::math::gamma_q(shape, x, Quiet());
  return q > boost_gamma_minimum ? std::log(q) : log_far_upper(shape, x);
}

double log_lower(double shape, double x) {
  if (x == 0) return special::lowest_log();
  if (shape <= most_for_sum) return log_far_lower(shape, x);
  const double p = boost::math::gamma_p(shape, x, Quiet());
  return p > boost_gamma_minimum ? std::log(p) : log_far_lower(shape, x);
}

}  // namespace

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

}  // namespace assay::stats
