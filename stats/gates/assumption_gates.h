#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "stats/basics/moments.h"

namespace assay::stats {

enum class GateState { green, amber, red };

// A diagnosis of one assumption. Green: the value is within the planning bound. Red: `low`, the
// lower confidence limit of the value, exceeds `limit`. Amber: in between. On normal data red has
// probability below 1e-4 at every sample size. At a law whose value is the limit it has about 1e-3
// (measurements.md).
struct Gate {
  std::string name;
  double value = 0;
  double low = 0;
  double limit = 0;
  GateState state = GateState::green;
};

// The gate with its state.
inline Gate judged(Gate gate, double green_up_to) {
  gate.state = gate.value <= green_up_to ? GateState::green
               : gate.low > gate.limit   ? GateState::red
                                         : GateState::amber;
  return gate;
}

// ---- On the pilot's primaries: how many make a secondary

// Smallest m at which means of m primaries have an excess kurtosis of at most the limit:
// `excess / m <= limit` (1 for negative excess). At .2 the level of F and chi-square stays below
// .12 at nominal .10.
std::uint64_t primaries_for_variance(double excess_kurtosis, double limit = 0.2);

// Value: |g1| / sqrt(averaged), the skewness of a mean of so many of the pilot's values. Green up
// to .3, which moves a tail of one per cent by a fifth at n = 2^14. It is also green up to what
// normal data exceed with probability .01. Else amber. Student's t takes values for near normal
// where it is green.
Gate near_normal_gate(const Moments& pilot, double averaged);

// Value: kurtosis_upper_limit over `averaged`; infinite for fewer than 4 values. Green up to the
// limit, else amber. Where it is green F and chi-square keep their level.
Gate small_kurtosis_gate(const Moments& pilot, double averaged, double limit);

// F and chi-square have 1.25 times their nominal level at this excess kurtosis, 0.2 at most. There
// the critical value x is divided by sqrt(1 + excess / 2).
double kurtosis_limit_at(double critical_value);

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

// On influence values, such as squares. Value: (sum w)^2 / sum w^2, w = (x - mean)^2, the effective
// number of observations in the sum of squares (Kish 1965). Its inverse is the relative variance of
// the variance of the mean: at 32 the standard error is known to 9 %. Below that the tail that was
// not seen may move it further than its law allows (measurements.md). Red below 32, green from 64
// on. Without fourth powers sum w / max w takes its place, which is less.
// For the contrast of the means of two samples, each of n has w = (x - mean)^2 / n^2.
inline constexpr double fewest_effective_observations = 32;
Gate effective_observations_gate(std::span<const Moments> samples);

// For F and chi-square tests of variances. Value: excess kurtosis b2 - 3. Green up to .2, limit .2.
// The confidence limit subtracts the 1e-4 quantile of b2. That quantile is Anscombe & Glynn's
// (1983) for normal data, widened to a gamma law whose excess is the limit.
Gate kurtosis_gate(const Moments& x);

// Upper 95 % confidence limit of the excess kurtosis, at least 0: k + 1.645 sqrt(Var b2). The
// variance is the delta method's at the gamma law of excess k (normal if k < 0). Throws
// std::domain_error for fewer than 4 values, ZeroVariance.
double kurtosis_upper_limit(const Moments& x);

// Gate on the rounding of values that are held against a continuous law by Kolmogorov and Smirnov.
// On a lattice the empirical distribution steps by the mass of a lattice point. That moves the
// distance D by up to half of it.
//
// Value: C / (2 d), C = sum c (c - 1) / (n (n - 1)) over the distinct values with counts c. C
// estimates sum p^2, the mean mass of a lattice point. The distance d = sqrt(ln(2 / level) / (2 n))
// is the one rejected at `level` (Massart 1990). The value is 0 if the distinct values are not on
// one lattice of at most 2^20 steps. Green up to the limit .05, red above. Throws std::domain_error
// for fewer than 2 values, a non-finite value, or level outside (0, 1).
Gate quantisation_gate(std::span<const double> sorted, double level);

// ---- On means of primaries

// Null hypothesis: `means` are independent means of `each` independent values of the law that
// `values` come from. So the G = floor(n / each) means of values 0, G, 2G, ...; 1, G + 1, ...; and
// the given ones are exchangeable. Their pooled ranks R = 0 ... N - 1, the mean rank for equal
// ones, have the law of a random order, whatever the law and its tails. Means are equal within
// each / 2^24, relative: sums in another order or in single precision round so. Their normal scores
// are a = Phi^-1((R + 1/2) / N).
//
// The sum of a sees another place (van der Waerden 1952), the sum of a^2 another spread (Klotz
// 1962). Both are held against their permutation means and variances, as z. Value: the larger |z|.
// It is red with probability 1e-7, amber below .01. Near 0 and green if there are fewer than 16
// means on either side. Throws std::domain_error for each = 0 and for values that are not finite.
Gate averages_gate(std::span<const double> values, std::span<const double> means, std::size_t each);

}  // namespace assay::stats
