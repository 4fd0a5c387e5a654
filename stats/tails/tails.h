#pragma once

#include <cstdint>

#include "stats/tails/test_result.h"

namespace assay::stats {

// Natural logarithms of the two tails at x: ln P(X <= x) and ln P(X >= x). The smaller one is
// computed as a tail; as one minus the other only where it is above .02. Where the probability is
// above 1e-300 it is right to 1e-10 relative; below, ln p is, and beyond -1e6 too. Always finite.
struct LogTails {
  double lower = 0;
  double upper = 0;
};

// ln min(1, 2 min(lower, upper)).
double log_p_two_sided(LogTails tails);

enum class Tail { lower, upper };

// A tail given by its log probability: the quantile q of {lower, ln a} has P(X <= q) = a, that of
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
double normal_upper(double x);  // ln P(X >= x); one alone is half the work
LogTails student_t_tails(double t, double degrees);
LogTails chi_square_tails(double x, double degrees);
LogTails gamma_tails(double x, double shape);  // unit scale
LogTails f_tails(double f, FDegrees degrees);
LogTails beta_tails(double x, BetaShape shape);
LogTails binomial_tails(std::uint64_t successes, Trials trials);  // P(K <= k), P(K >= k)
double binomial_lower(std::uint64_t successes, Trials trials);    // one alone is half the work
double binomial_upper(std::uint64_t successes, Trials trials);
LogTails noncentral_t_tails(double t, Noncentral parameters);
LogTails noncentral_chi_square_tails(double x, Noncentral parameters);

// Quantiles, by inversion of the log tails. An overflowing quantile (Student's t with few degrees
// of freedom, far out) is infinite. log_probability must be below 0.
double normal_quantile(LogTail tail);
double student_t_quantile(LogTail tail, double degrees);
double chi_square_quantile(LogTail tail, double degrees);
double f_quantile(LogTail tail, FDegrees degrees);
double beta_quantile(LogTail tail, BetaShape shape);
double noncentral_chi_square_quantile(LogTail tail, Noncentral parameters);

// The tails of any law that a TestResult names, except "bound" and "image-family"
// (std::domain_error).
LogTails log_tails(const Distribution& distribution, double statistic);

// ln(1 - e^x) for x <= 0 and ln(e^a + e^b), without cancellation or overflow.
double log_complement(double log_probability);
struct LogPair {
  double first;
  double second;
};
double log_sum(LogPair terms);

}  // namespace assay::stats
