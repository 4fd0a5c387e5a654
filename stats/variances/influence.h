#pragma once

#include <functional>
#include <vector>

#include "stats/basics/joint_moments.h"
#include "stats/means/uncertain_reference.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// A positive quantity that is a smooth function of means has influence values psi_i. The estimate
// is their mean, but for terms of order 1 / n (Hampel 1974, J. Am. Stat. Assoc. 69). A variance, a
// mean squared error, a mean cost and their products are such quantities.
struct Influence {
  double log_value = 0;  // ln of the estimate.
  Moments relative;      // Of psi_i over the estimate: their mean is 1.
};

// The mean of positive values, such as costs: psi = value. The spread may be zero. Throws
// std::domain_error (count < 2, mean not positive).
Influence influence_of_mean(const Moments& positive);

// s2: psi = n / (n - 1) d^2 with d = x - mean. The sum of squares of psi includes 2 s^4, the second
// order of Var s2. With it Var s2 of normal values is right to order 1 / n^2. The sum of fourth
// powers, which is the error of that of the squares, includes 16 (sum psi d)^2 / sum d^2. So much
// the error of the mean moves the squares. It is large where psi hardly varies, as of two values
// that are nearly as frequent. Where the sums are known to weight 4 only, the skewness of psi
// counts as 0, and influence_t is the plain t. These three throw std::domain_error (count < 4,
// powers that are not finite), ZeroVariance.
Influence influence_of_variance(const JointMoments& sample);
// s2 times the mean cost c. The inverse is the efficiency.
//   psi = c (d^2 - s2) + s2 (cost - c) + s2 c.
Influence influence_of_variance_and_cost(const JointMoments& sample);
// The same with the mean squared error about a truth t: (x - t)^2 in the place of d^2.
Influence influence_of_error_and_cost(const JointMoments& sample, double truth);

// Null hypothesis: ln of the quantity = log_value. Student's t of the influence values with Hall's
// correction for skewness (stats/means/skewness_corrected_t.h). Asymptotic: use it where
// residual_skewness_gate and effective_observations_gate of the influence values are green. A
// quantity without spread is compared exactly but for influence_rounding: the law is "bound".
TestResult influence_t(const Influence& x, double log_value);

// Null hypothesis: ln of the ratio x / y = log_ratio. Tests E psi_x - ratio E psi_y = 0 (Fieller
// 1954, J. R. Statist. Soc. B 16), by Welch's t with Hall's correction.
TestResult influence_t(const Influence& x, const Influence& y, double log_ratio);

// One quantity of a ratio. A mean squared error depends on a truth, which may be uncertain; other
// quantities ignore it.
struct RatioSide {
  std::function<Influence(double truth)> influence;
  UncertainReference truth = {};
};

// theta = ln(first / second / null), or ln(first / null), or minus that.
struct LogRatio {
  std::vector<RatioSide> sides;
  double log_null = 0;
  double sign = 1;  // -1 if the sides are inverses of the quantities.
};

// Evidence about theta, by influence_t over the truths (uncertain_reference.h). Two equal truths
// are one, with one error. Without an error the interval is the estimate.
Evidence log_ratio_evidence(const LogRatio& ratio);

// Relative tolerance for equal quantities without spread. It is larger than the rounding of a
// claim's factor, its logarithm and a product, and smaller than the difference of whole costs below
// 1e12.
inline constexpr double influence_rounding = 1e-12;

}  // namespace assay::stats
