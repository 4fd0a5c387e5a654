#pragma once

#include "stats/joint_moments.h"
#include "stats/power.h"
#include "stats/student_t.h"
#include "stats/test_result.h"

namespace assay::stats {

// Efficiency = 1 / (error x cost): error is the variance, or for a biased estimator the mean
// squared error about a reference; cost is the mean cost of one observation.
//
// `value` is ln efficiency. Its error has two independent parts: the sample's own, spread / count,
// and reference_slope times the error of the reference, which two estimators may share.
struct LogEfficiency {
  double value = 0;
  double spread = 0;  // count x variance of `value`: plan with it
  double count = 0;
  double reference_slope = 0;  // d value / d reference
  double reference_error = 0;  // standard error of the reference

  double standard_error() const;
};

// ln(1 / (s2 mean cost)). The influence of one observation on its negative is
//   psi = (d^2 / s2 - 1) + (cost / mean cost - 1),  d = x - mean x,
// so spread = (b2 - (n-3)/(n-1)) + Var(cost) / mean^2 + 2 Cov(d^2, cost) / (s2 mean): the delta
// method with the covariance of squared deviation and cost, the variance term as in log_variance.h.
// A constant cost contributes nothing. Throws std::domain_error (count < 4, mean cost not
// positive), ZeroVariance.
LogEfficiency log_efficiency_of(const JointMoments& sample);

// ln(1 / (MSE mean cost)) with MSE = mean (x - r)^2 - u^2, unbiased for E (x - truth)^2 when the
// reference r has standard error u and is independent of the sample. The influence uses (x - r)^2
// in the place of d^2; the slope in r is 2 (mean - r) / MSE. Throws as above, and std::domain_error
// when MSE <= 0: the reference is then too inaccurate to say anything.
LogEfficiency log_efficiency_of(const JointMoments& sample, Reference reference);

// Null hypothesis: efficiency = null_efficiency. Z = (value - ln null) / SE, asymptotic: n >= 1000.
TestResult log_efficiency(const LogEfficiency& x, double null_efficiency);

// Central interval of ln(efficiency / reference_efficiency).
Interval log_efficiency_interval(const LogEfficiency& x, double reference_efficiency,
                                 double confidence);

// Whether two biased estimators were held against one reference: its error then enters both alike.
enum class References { independent, shared };

// Null hypothesis: efficiency x / efficiency y = null_ratio. Z = (difference of values - ln
// null_ratio) / SE, asymptotic. With a shared reference the slopes are subtracted before squaring;
// their reference errors must agree (std::domain_error).
TestResult log_efficiency_ratio(const LogEfficiency& x, const LogEfficiency& y, double null_ratio,
                                References references = References::independent);

// Central interval of ln(efficiency x / efficiency y).
Interval log_efficiency_ratio_interval(const LogEfficiency& x, const LogEfficiency& y,
                                       double confidence,
                                       References references = References::independent);

// Sample sizes: log_variance_power, _detectable and _sample_size of this plan, with ratios of
// efficiencies as effects. One sample: spread_y = 0. A reference's error is not part of it.
struct EfficiencyPlan {
  double spread_x = 2;
  double spread_y = 0;
  double allow = 1;  // ratio
  ErrorRates rates;
};
LogVariancePlan efficiency_plan(const EfficiencyPlan& plan);

}  // namespace assay::stats
