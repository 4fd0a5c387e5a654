#pragma once

#include <optional>
#include <vector>

#include "stats/tails/test_result.h"

namespace assay::stats {

// The exponent s of a power law E b(M) = C M^s, from estimates b at several sizes M. No logarithm
// of a noisy number is taken: a slope s is held against the data by asking whether M^-s b is one
// constant over the points,
//   Q(s) = min over C of r' V^-1 r,  r = b - C M^s,  V = diag(standard_error^2) +
//   reference_error^2,
// chi-square with K - 1 degrees of freedom under E b = C M^s, whatever C, zero included
// (generalised least squares at a fixed shape; Rao 1973, 4a.2; the inversion is Fieller's
// argument). Exact for normal b with known errors, hence asymptotic.
struct SlopePoint {
  double size = 1;            // M > 0
  double estimate = 0;        // b: a bias, a variance, a cost
  double standard_error = 1;  // of b alone
};

enum class SlopeScale {
  // As above. What may be zero or of either sign: biases.
  values,
  // `estimate` is the natural logarithm of a positive quantity (a variance, a mean cost) and
  // standard_error that of the logarithm: Q(s) = min over C of the same form with r = b - C - s ln
  // M.
  // A common error of the logarithms cancels.
  logarithms,
};

// At least two points of different sizes, in any order. All functions throw std::domain_error for
// fewer, for sizes not positive, equal or not finite, for estimates not finite, for a standard
// error or a reference error that is negative or not finite, and ZeroVariance for a standard error
// of zero.
struct SlopeData {
  std::vector<SlopePoint> points;
  double reference_error = 0;  // standard error of a reference that all biases share
  SlopeScale scale = SlopeScale::values;
};

struct SlopeTest {
  // Null hypothesis: slope = null. ln P(chi-square >= Q(null)).
  double log_p_equal = 0;
  // log_p_upper rejects "slope <= null": the largest ln p over all slopes up to null; log_p_lower
  // mirrors it. Their smaller one is log_p_equal where the estimate lies on one side, so doubling
  // it (log_p_two_sided) is valid but wasteful: use log_p_equal. statistic = Q(null).
  TestResult test;
};
SlopeTest slope_test(const SlopeData& data, double null_slope);

// log_p_equal alone, without the search over all slopes that the one-sided values need.
double log_p_of_slope(const SlopeData& data, double null_slope);

// The smallest interval that holds every slope with p > 1 - confidence. Confidence is that of the
// equality test, not split over two sides: slopes outside are rejected at 1 - confidence each, so
// that "slope outside [low, high]" is rejected at beta by the interval at confidence 1 - beta.
struct SlopeSet {
  Interval hull;
  bool empty = false;     // no power law at all fits the points; the hull is then NaN
  bool connected = true;  // false: inner slopes of the hull are rejected too
  // An unbounded set has an infinite end: the estimates at the small or the large sizes cannot be
  // told from zero, so that no slope is too steep.
};
SlopeSet slope_set(const SlopeData& data, double confidence);

struct SlopeEstimate {
  double slope = 0;  // argmin Q; +-infinity when the best fit has but one point different from 0
  double log_p_fit = 0;  // ln P(chi-square, K - 2 degrees >= Q(slope)): is it a power law at all?
  // ln P(chi-square, K - 1 degrees >= Q(slope)), the largest of any slope: below ln(1 - confidence)
  // slope_set() is empty, which under a power law has probability 1 - confidence at most.
  double log_p_best = 0;
};
SlopeEstimate slope_estimate(const SlopeData& data);

// Power of the equality test of null_slope at alpha when the expectations of the points are
// data.points: noncentral chi-square with ncp = Q(null_slope).
double slope_power(const SlopeData& expected, double null_slope, double alpha);

// By which factor to multiply every sample (standard errors shrink by its root, the reference's
// does not) for power 1 - beta; nothing when no factor suffices.
struct SlopeRates {
  double alpha = 0.01;
  double beta = 0.01;
};
std::optional<double> slope_sample_factor(const SlopeData& expected, double null_slope,
                                          SlopeRates rates);

}  // namespace assay::stats
