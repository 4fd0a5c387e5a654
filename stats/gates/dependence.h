#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stats/gates/assumption_gates.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Samples in the order in which they were made. Throughout,
//   c_k = (1/n) sum_(t > k) (x_t - mean) (x_(t-k) - mean),  r_k = c_k / c_0.

// r_lag. Throws std::domain_error (lag >= n, non-finite values), ZeroVariance.
double autocorrelation(std::span<const double> values, std::size_t lag);

// Null hypothesis: independent values of one law.
//   Z = (r_1 + 1/n) / sqrt(V).
//   V = (n^4 - 4 n^3 + 3 n^2 + 4 n - 4) / ((n + 1) n^2 (n - 1)^2).
// Mean and variance of r_1 are exact for normal data (Dufour & Roy 1985, J. Econometrics 29). They
// hold to first order for any law with a variance (Anderson & Walker 1964). So does its skewness, s
// = g^2 / sqrt n, where g is that of the values. log_p_upper is the tail of positive correlation.
// It is that of Pearson's law of type III with the skewness s. log_p_lower is normal. Throws
// std::domain_error for n < 4 and non-finite values, ZeroVariance.
TestResult lag_one_test(std::span<const double> values, const char* caller = "lag_one_test");

// Effective sample size n / tau, tau = -1 + 2 sum Gamma_m, Gamma_m = r_2m + r_(2m+1). The sum runs
// while Gamma_m is positive, made monotone (Geyer 1992, Stat. Sci. 7, section 3.3). It is about n
// for independent values, and n (1 - phi) / (1 + phi) for an AR(1) chain. It may exceed n for
// alternating sequences, up to n log10 n (Vehtari et al. 2021, Bayesian Anal. 16). Time n tau.
// Throws std::domain_error for n < 4 and non-finite values, ZeroVariance.
double effective_sample_size(std::span<const double> values);

// floor(sqrt n), the default length of a batch.
std::size_t default_batch(std::size_t n);
// The moments of the means of floor(n / length) whole batches. The rest at the end is left out.
// Their variance times the length estimates lim n Var(mean).
// student_t on them tests the mean of a stationary sequence, asymptotically. It needs at least 20
// batches of about ten integrated autocorrelation times (Glynn & Iglehart 1990). Throws
// std::domain_error for fewer than two batches or length 0.
Moments batch_means(std::span<const double> values, std::size_t length);

// ---- Ranks

// Rank correlations of values that stand further apart than neighbours. They find chains that were
// written step by step, one value of each in turn. Equal values are ranked in an order drawn by
// their places. For lag k = first ... K,
//   z_k = (r_k + 1 / n) n / sqrt(n - k),   K = min(last, n / 4, 1000, 2e8 / n).
// Each z_k is near standard normal for independent values of any one law.
struct LaggedCorrelation {
  std::size_t lag = 0;
  double correlation = 0;  // r_k
  double z = 0;
};

// All of them; none if n < 8 or all values are equal. Time n K.
std::vector<LaggedCorrelation> lagged_correlations(std::span<const double> values,
                                                   std::size_t first = 2, std::size_t last = 1000);

// Spearman's correlation of the midranks of values side by side; 0 if either are all equal. Of
// independent samples its variance is 1 / (n - 1). The samples must have one size.
double rank_correlation(std::span<const double> x, std::span<const double> y);

// The rank correlation of two sequences of one size if it is farther than 6 standard errors from 0,
// as of pairs; nothing else. That of two independent chains varies more, by the sum of their
// autocorrelations' products (Bartlett 1935). The sum is at most the root of the sums of their
// squares. What still correlates at the last lag has no such sum.
std::optional<double> correlation_of_pairs(std::span<const double> x, std::span<const double> y);

// The one whose z is farthest from 0. Its lag is 0 if there is none.
LaggedCorrelation worst_of(std::span<const LaggedCorrelation> all);

// Gates of independence, for values in the order in which they were made. On independent normal
// values each is red with probability 5e-5.

// Value: r_1, the correlation of neighbours. Limit: the r_1 at which lag_one_test
// has the two-sided p-value 5e-5. Green up to that of .01. Sees what changes from value to value: a
// Markov chain, sorted values, antithetic pairs. Throws as lag_one_test.
Gate lag_one_gate(std::span<const double> values);

// Value: n_b Var(batch means) / Var within batches, for batches of floor(sqrt n). The rest at the
// end is left out. It is 1 for independent values, and about the integrated autocorrelation time if
// that is long. For independent normal values it is exactly F with (batches - 1, batches (length -
// 1)) degrees of freedom. An excess kurtosis k of the values divides the former by 1 + k / (2
// length), the latter by 1 + k / 2 (Box 1953). Limit: its upper quantile at 5e-5. Green up to that
// at .01. Sees drifts and slow chains that lag one does not. Throws std::domain_error for n < 9;
// ZeroVariance.
Gate batch_gate(std::span<const double> values);

// Value: the rank correlation that is farthest from 0, over lags 2 to K.
// Limit: its value at z of 5e-5 / (K - 1), two-sided. Sees chains that take turns in a file. Green
// if there are no such lags.
Gate lagged_gate(std::span<const double> values);

// Null hypothesis: what an estimator draws is independent, of any one law. Two gates rest on ranks,
// whose law is that of a random order, whatever the values. Each is red with probability 1e-7 at
// most, and amber below .01. A third stands there, red, if a run of values comes again (copies.h),
// as from seeds that do. Below 8 values there are none.
//
// The first has the rank correlation r_k that is farthest from 0. Lags k = 1 ... 16 are of all
// values, k = 17 ... K of the first 2048. The second has the largest `H / B`, over
// `B = floor(n / L) >= 8` batches of `L = 8, 16, ...` neighbours. S_b is the sum of the ranks of
// batch b, less their mean.
//  `H = 12 / (L n (n + 1)) sum S_b^2`.
// H is near chi-square of at most B degrees of freedom (Kruskal & Wallis 1952). It sees offsets
// that neighbours share, and slow chains, which no single lag shows.
std::vector<Gate> drawn_order_gates(std::span<const double> values);

// Integrated autocorrelation time n Var(mean) / Var x by effective_sample_size. More than 8192
// values are first averaged with neighbours, which keeps n Var(mean). Throws as
// effective_sample_size.
double autocorrelation_time(std::span<const double> values);
// Factor for the variance of a mean of n values, for a dependence too weak for the gates. It is the
// larger of autocorrelation_time and the F of batches of floor(sqrt n) or n / 10. It applies only
// if the r_1 or that F is beyond what independent values exceed with probability .05.
// Otherwise it is 1. It at best halves the errors of a slow chain under much noise. Throws as
// batch_gate.
double allowance_for_dependence(std::span<const double> values);
// A batch length that suffices for batch_means. It is the largest of default_batch, ten
// autocorrelation times rounded up, and five times the farthest correlated lag. That lag has a
// positive rank correlation beyond chance for values with such a time. Chains that take turns
// correlate at their number, where the time has stopped summing. The length is raised until less
// than a batch is left over. Throws as autocorrelation_time.
std::size_t sufficient_batch(std::span<const double> values);

}  // namespace assay::stats
