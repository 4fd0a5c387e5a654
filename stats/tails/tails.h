#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "stats/tails/test_result.h"

namespace assay::stats {

// Natural logarithms of the two tails at x: ln P(X <= x) and ln P(X >= x). The smaller one is
// computed as a tail, or as one minus the other if above .02. Relative accuracy is 1e-10 in p above
// 1e-300, and 1e-10 in ln p below. Always finite.
struct LogTails {
  double lower = 0;
  double upper = 0;
};

// ln min(1, 2 min(lower, upper)).
double log_p_two_sided(LogTails tails);

// The result of a statistic whose law has these tails there.
inline TestResult by_tails(double statistic, Distribution law, LogTails tails) {
  return {statistic, std::move(law), tails.lower, tails.upper};
}

// The result of a difference that is known without error: nothing speaks against 0, and any other
// is certain.
TestResult without_error(double difference, const char* law);

enum class Tail { lower, upper };

// A tail given by its log probability. The quantile q of {lower, ln a} has P(X <= q) = a. That of
// {upper, ln a} has P(X >= q) = a.
struct LogTail {
  Tail tail = Tail::lower;
  double log_probability = 0;
};

struct FDegrees {
  double numerator = 1;
  double denominator = 1;
};
struct BetaShape {
  double alpha = 1;
  double beta = 1;
};
struct Trials {
  std::uint64_t trials = 1;
  double probability = 0.5;
};
struct Noncentral {
  double degrees = 1;
  double noncentrality = 0;
};

// Degrees of freedom need not be whole. All throw std::domain_error for parameters out of range and
// for non-finite arguments.
LogTails normal_tails(double x);
// ln P(X >= x). One tail alone is half the work.
double normal_upper(double x);
LogTails student_t_tails(double t, double degrees);
LogTails chi_square_tails(double x, double degrees);
LogTails gamma_tails(double x, double shape);  // Unit scale.
LogTails f_tails(double f, FDegrees degrees);
LogTails beta_tails(double x, BetaShape shape);
// P(K <= k), P(K >= k).
LogTails binomial_tails(std::uint64_t successes, Trials trials);
// One tail alone is half the work.
double binomial_lower(std::uint64_t successes, Trials trials);
double binomial_upper(std::uint64_t successes, Trials trials);
LogTails noncentral_t_tails(double t, Noncentral parameters);
LogTails noncentral_chi_square_tails(double x, Noncentral parameters);

// Quantiles, by inversion of the log tails. A quantile too large for a double is infinite.
// log_probability must be below 0.
double normal_quantile(LogTail tail);
// The value that a standard normal variable exceeds with this probability.
inline double upper_normal_quantile(double probability) {
  return normal_quantile({Tail::upper, std::log(probability)});
}
double student_t_quantile(LogTail tail, double degrees);
double chi_square_quantile(LogTail tail, double degrees);
double f_quantile(LogTail tail, FDegrees degrees);
double beta_quantile(LogTail tail, BetaShape shape);
double noncentral_chi_square_quantile(LogTail tail, Noncentral parameters);

// The standard normal z with the tail of Student's t: Phi(z) = F_nu(t). The approximation is Hill's
// (1970, Algorithm 395, Communications of the ACM 13, 617):
//  `y = (nu - 1/2) ln(1 + t^2 / nu),  b = 48 (nu - 1/2)^2
//   z = sign(t) sqrt(y) (1 + (y + 3 - (.4 y^3 + 3.3 y^2 + 24 y + 85.5) / (.8 y^2 + 100 + b)) / b)`.
// For |z| <= 6 the error is at most 5e-4 at nu = 7, 9e-7 at 15 and 2e-8 at 30
// (tests/tables/t_to_z.csv). Use it for maps and for choosing a maximum. A reported p-value comes
// from the exact law. For an infinite nu z is t, for nu <= 1/2 not a number.
struct StudentValue {
  double t = 0;
  double degrees = 1;
};
inline double t_to_z(StudentValue value) {
  if (std::isinf(value.degrees)) return value.t;
  const double a = value.degrees - 0.5;
  const double b = 48 * a * a;
  const double y = a * std::log1p(value.t * value.t / value.degrees);
  const double tail = ((0.4 * y + 3.3) * y + 24) * y + 85.5;
  const double size = std::sqrt(y) * (1 + (y + 3 - tail / (0.8 * y * y + 100 + b)) / b);
  return std::copysign(size, value.t);
}

// ln(1 - e^x) for x <= 0 and ln(e^a + e^b), without cancellation or overflow.
double log_complement(double log_probability);
double log_sum(double a, double b);

}  // namespace assay::stats
