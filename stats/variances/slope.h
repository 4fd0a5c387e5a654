#pragma once

#include <optional>
#include <vector>

#include "stats/planning/power.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// The exponent s of a power law E b(M) = C M^s, from estimates b at several sizes M. No logarithm
// of a noisy number is taken. A slope s fits if M^-s b is one constant over the points:
//   Q(s) = min over C of r' V^-1 r,  r = b - C M^s,
//   V = diag(standard_error^2) + reference_error^2.
// Under E b = C M^s, Q is chi-square with K - 1 degrees of freedom, whatever C, zero included.
// (Generalised least squares at a fixed shape; Rao 1973, 4a.2. The inversion is Fieller's
// argument.) Exact for normal b with known errors, hence asymptotic.
struct SlopePoint {
  double size = 1;            // M > 0.
  double estimate = 0;        // b: a bias, a variance, a cost.
  double standard_error = 1;  // Error of b alone.
};

enum class SlopeScale {
  // Q as above, for biases and other estimates that may be zero or of either sign.
  values,
  // For a positive quantity such as a variance or a mean cost. `estimate` is its natural logarithm
  // and standard_error that of the logarithm. Q(s) then has r = b - C - s ln M. A common error of
  // the logarithms cancels.
  logarithms,
};

// At least two points of different sizes, in any order. All functions throw std::domain_error for
// fewer points, and for sizes not positive, equal or not finite. They throw it for estimates not
// finite and for errors negative or not finite. A standard error of zero throws ZeroVariance.
struct SlopeData {
  std::vector<SlopePoint> points;
  double reference_error = 0;  // Standard error of a reference that all biases share.
  SlopeScale scale = SlopeScale::values;
};

// Null hypothesis: slope = null. The upper tail, `log_p_upper`, rejects "slope <= null": the
// largest ln p over all slopes up to null, where p is P(chi-square >= Q). The mirror is
// log_p_lower. Their smaller one is that of the null if the estimate lies on one side. Doubling it
// (log_p_two_sided) is valid but wasteful. The statistic is Q(null).
TestResult slope_test(const SlopeData& data, double null_slope);

// The smallest interval that holds every slope with p > 1 - confidence. Confidence is that of the
// equality test, not split over two sides. Slopes outside are rejected at 1 - confidence each. So
// the interval at confidence 1 - beta rejects "slope outside [low, high]" at beta. Both ends are
// NaN if no power law fits the points. An end is infinite if no slope is too steep: the estimates
// at the small or the large sizes cannot be told from zero.
Interval slope_set(const SlopeData& data, double confidence);

struct SlopeEstimate {
  // argmin Q; +-infinity when the best fit has but one point different from 0.
  double slope = 0;
  // ln P(chi-square, K - 1 degrees >= Q(slope)), the largest of any slope. Below ln(1 - confidence)
  // slope_set() is NaN. Under a power law that has probability at most 1 - confidence.
  double log_p_best = 0;
};
SlopeEstimate slope_estimate(const SlopeData& data);

// ln p of the slope that fits best. Of points without error, such as costs that never vary, it is
// 0, or minus infinity where the slopes between neighbours differ by more than rounding.
double log_p_of_power_law(const SlopeData& data);

// Evidence about theta, the slope less the null value. Points without error have the range of
// slopes between neighbours, in the order given; p is 0 or 1 (law "bound"). Slopes that differ by
// 1e-12, the rounding of quotients of logarithms of whole numbers, are equal.
Evidence slope_evidence(const SlopeData& data, double null_slope);

// Power of the equality test of null_slope at alpha when the expectations of the points are
// data.points. Noncentral chi-square with ncp = Q(null_slope).
double slope_power(const SlopeData& expected, double null_slope, double alpha);

// The factor for every sample size that gives power 1 - beta, at alpha or half of it if two-sided.
// Standard errors shrink by its root, the reference's does not. Nothing if no factor suffices.
std::optional<double> slope_sample_factor(const SlopeData& expected, double null_slope,
                                          ErrorRates rates);

}  // namespace assay::stats
