#pragma once

#include "stats/basics/joint_moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Efficiency = 1 / (error x cost). The error is the variance or, for a biased estimator, the mean
// squared error about a reference. The cost is the mean cost of one observation.
//
// `value` is ln efficiency, with variance spread / count. Plan with it.
struct LogEfficiency {
  double value = 0;
  double spread = 0;
  double count = 0;

  double standard_error() const;
};

// ln(1 / (s2 mean cost)). One observation's influence on its negative is
//   psi = (d^2 / s2 - 1) + (cost / mean cost - 1).
// Here d = x - mean x. The delta method then gives
//   spread = (b2 - (n-3)/(n-1)) + Var(cost) / mean^2 + 2 Cov(d^2, cost) / (s2 mean).
// The variance term is as in log_variance.h. A constant cost contributes nothing. Throws
// std::domain_error (count < 4, mean cost not positive), ZeroVariance.
LogEfficiency log_efficiency_of(const JointMoments& sample);

// ln(1 / (MSE mean cost)) with MSE = mean (x - truth)^2. The influence uses (x - truth)^2 in the
// place of d^2. For a truth known up to an error use uncertain_reference.h, turning at mean x.
// Throws as above.
LogEfficiency log_efficiency_of(const JointMoments& sample, double truth);

// Null hypothesis: efficiency = null_efficiency. Z = (value - ln null) / SE, asymptotic: n >= 1000.
TestResult log_efficiency(const LogEfficiency& x, double null_efficiency);

// Central interval of ln(efficiency / reference_efficiency).
Interval log_efficiency_interval(const LogEfficiency& x, double reference_efficiency,
                                 double confidence);

// Null hypothesis: efficiency x / efficiency y = null_ratio. Z = (difference of values - ln
// null_ratio) / SE, asymptotic.
TestResult log_efficiency_ratio(const LogEfficiency& x, const LogEfficiency& y, double null_ratio);

// Central interval of ln(efficiency x / efficiency y).
Interval log_efficiency_ratio_interval(const LogEfficiency& x, const LogEfficiency& y,
                                       double confidence);

// Sample sizes: log_variance_power, _detectable and _sample_size. Pass `spread` + 1 as kurtosis and
// ratios of efficiencies as effects. They ignore a reference's error.

}  // namespace assay::stats
