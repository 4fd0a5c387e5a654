#pragma once

#include <cstdint>

#include "stats/basics/gate.h"
#include "stats/basics/moments.h"

namespace assay::stats {

// ---- On the pilot's primaries: choose how many make a secondary

// Shape of one primary. Means of m have skewness / sqrt(m) and excess_kurtosis / m.
struct PrimaryShape {
  double skewness = 0;
  double excess_kurtosis = 0;
};
PrimaryShape primary_shape(const Moments& pilot);

struct ShapeLimits {
  double excess_kurtosis = 0.2;  // F and chi-square: at nominal .10 the level stays below .12
  double level_factor = 1.25;    // t: exp(2 |a| x^3), see skewness_gate
};

// The planned test: how many secondary estimates, and the critical value x of its smallest share.
struct PlannedTest {
  std::uint64_t secondaries = 2;
  double critical_value = 0;
};

// Smallest m with excess_kurtosis / m <= limits.excess_kurtosis (1 for negative excess).
std::uint64_t primaries_for_variance(PrimaryShape shape, ShapeLimits limits = {});
// Smallest m with exp(|skewness| x^3 / (3 sqrt(m secondaries))) <= limits.level_factor.
std::uint64_t primaries_for_mean(PrimaryShape shape, PlannedTest test, ShapeLimits limits = {});

// What the gates are predicted to read with m primaries a secondary; low = value, as planning has
// no error of its own to allow for. Red above the planning bound.
Gate predicted_kurtosis_gate(PrimaryShape shape, std::uint64_t primaries, ShapeLimits limits = {});
Gate predicted_skewness_gate(PrimaryShape shape, std::uint64_t primaries, PlannedTest test,
                             ShapeLimits limits = {});

// ---- On the test's own data: can only invalidate

// Value: exp(2 |a| x^3), the factor by which the worse tail of a Studentised mean at critical value
// x departs from nominal, 2 |a| = |g1| / (3 sqrt n) (self-normalised moderate deviations: Jing,
// Shao & Wang 2003). green <= 1.25, limit 2. The confidence limit takes from |g1| its 1e-4
// quantile: for normal data by D'Agostino (1970), widened to a gamma law whose factor is the limit.
Gate skewness_gate(const Moments& x, double critical_value);
// The same of the contrast mean x - scale mean y: a = sum psi^3 / (6 (sum psi^2)^1.5).
Gate skewness_gate(const Moments& x, const Moments& y, double scale, double critical_value);
// The same of ln of a mean of positive values (`of`: "cost"), with
// log_mean_slope (log_variance_level.h) for |g1| / 3; the confidence limit takes the error of g1
// alone. Of two sides each has its own, a bound. std::domain_error where the mean is not positive.
Gate log_mean_gate(const Moments& positive, double critical_value, const std::string& of);

// The |g1| that normal samples of n exceed with this probability: D'Agostino (1970), n >= 8.
// Smaller samples cannot tell, their g1 being capped at (n - 2) / sqrt(n - 1): infinite.
double normal_skewness_quantile(double n, double probability);

// Value: max |x_i - mean| / (s sqrt n), whose square is one observation's share of the sum of
// squares: none may dominate. Limit .5, or where normal data exceed it by themselves, the 1e-4
// critical value of Grubbs (1950), which is the exact allowance, so low = value; green up to .5 or
// the 5 % critical value. At .5 one observation alone makes a skewness of 2a = .04, which is the
// limit of the skewness gate at the level .01; smaller values go with sound levels (README.md).
Gate dominance_gate(const Moments& x);

// Value: excess kurtosis b2 - 3 for F and chi-square tests of variances, green <= .2, limit .2. The
// confidence limit takes off the 1e-4 quantile of b2, for normal data by Anscombe & Glynn (1983),
// widened to a gamma law whose excess is the limit.
Gate kurtosis_gate(const Moments& x);

// Upper 95 % confidence limit of the excess kurtosis, 0 at least: k + 1.645 sqrt(Var b2), by the
// delta method at the gamma law of excess k (normal where k < 0). std::domain_error for fewer than
// 4 values, ZeroVariance.
double kurtosis_upper_limit(const Moments& x);

}  // namespace assay::stats
