#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

#include "stats/check.h"
#include "stats/special.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

namespace policies = boost::math::policies;
using Quiet = policies::policy<policies::overflow_error<policies::ignore_error>,
                               policies::evaluation_error<policies::ignore_error>,
                               policies::promote_double<false>>;

// Below this Boost's result may be denormal; the log forms take over long before.
constexpr double boost_minimum = 1e-280;

// ln P(a, x) = prefix - ln a + ln sum x^k / ((a+1) … (a+k)); DLMF 8.7.1.
double log_far_lower(double shape, double x) {
  double term = 1;
  double sum = 1;
  for (double k = 1; term > sum * 1e-17; ++k) {
    term *= x / (shape + k);
    sum += term;
  }
  return special::log_gamma_prefix(shape, x) - std::log(shape) + std::log(sum);
}

// ln Q(a, x) by Legendre's continued fraction, DLMF 8.9.2, evaluated by Lentz's method.
double log_far_upper(double shape, double x) {
  double b = x + 1 - shape;
  double c = std::numeric_limits<double>::max();
  double d = 1 / b;
  double fraction = d;
  for (double k = 1; k < 1e7; ++k) {
    const double a = -k * (k - shape);
    b += 2;
    d = 1 / (a * d + b);
    c = b + a / c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-16) break;
  }
  return special::log_gamma_prefix(shape, x) + std::log(fraction);
}

double log_upper(double shape, double x) {
  const double q = boost::math::gamma_q(shape, x, Quiet());
  return q > boost_minimum ? std::log(q) : log_far_upper(shape, x);
}

double log_lower(double shape, double x) {
  if (x == 0) return special::lowest_log();
  const double p = boost::math::gamma_p(shape, x, Quiet());
  return p > boost_minimum ? std::log(p) : log_far_lower(shape, x);
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
