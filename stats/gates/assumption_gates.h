#pragma once

#include <cstdint>

#include "stats/basics/gate.h"
#include "stats/basics/moments.h"

namespace assay::stats {

// ---- On the pilot's primaries: how many make a secondary

// Shape of one primary. Means of m primaries have skewness / sqrt(m) and excess_kurtosis / m.
struct PrimaryShape {
  double skewness = 0;
  double excess_kurtosis = 0;
};
PrimaryShape primary_shape(const Moments& pilot);

struct ShapeLimits {
  double excess_kurtosis = 0.2;  // For F and chi-square. At nominal .10 the level stays below .12.
};

// Smallest m with excess_kurtosis / m <= limits.excess_kurtosis (1 for negative excess).
std::uint64_t primaries_for_variance(PrimaryShape shape, ShapeLimits limits = {});
// ---- On the test's own data

// Value: exp(2 |a| x^3), 2 |a| = |g1| / (3 sqrt n). The worse tail of a Studentised mean departs
// from nominal by this factor at critical value x. (Self-normalised moderate deviations: Jing, Shao
// & Wang 2003.) Green up to 1.25, limit 2. The confidence limit subtracts from |g1| its 1e-4
// quantile. That quantile is D'Agostino's (1970) for normal data, widened to a gamma law whose
// factor is the limit.
Gate skewness_gate(const Moments& x, double critical_value);
// The same for the contrast mean x - scale mean y: a = sum psi^3 / (6 (sum psi^2)^1.5).
Gate skewness_gate(const Moments& x, const Moments& y, double scale, double critical_value);

// The |g1| that normal samples of n exceed with this probability (D'Agostino 1970, n >= 8).
// Infinite for smaller n, whose g1 cannot exceed (n - 2) / sqrt(n - 1).
double normal_skewness_quantile(double n, double probability);

// Value: max (x_i - mean)^2 / ((n - 1) s^2), one observation's share of the sum of squares. Limit:
// .5, or the 1e-4 critical value of Grubbs (1950) where normal data exceed .5. That is the exact
// allowance, so low = value. Green up to .25 or the 5 % critical value.
Gate dominance_gate(const Moments& x);

// For F and chi-square tests of variances. Value: excess kurtosis b2 - 3. Green up to .2, limit .2.
// The confidence limit subtracts the 1e-4 quantile of b2. That quantile is Anscombe & Glynn's
// (1983) for normal data, widened to a gamma law whose excess is the limit.
Gate kurtosis_gate(const Moments& x);

// Upper 95 % confidence limit of the excess kurtosis, at least 0: k + 1.645 sqrt(Var b2). The
// variance is the delta method's at the gamma law of excess k (normal if k < 0). Throws
// std::domain_error for fewer than 4 values, ZeroVariance.
double kurtosis_upper_limit(const Moments& x);

}  // namespace assay::stats
