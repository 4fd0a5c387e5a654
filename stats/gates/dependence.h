#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stats/basics/moments.h"
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
// The Z of the same sign whose tail has this probability.
double lag_one_critical(const TestResult& test, double probability);

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
//   z_k = (r_k + 1 / n) n / sqrt(n - k),   K = min(n / 4, 1000, 2e8 / n).
// Each z_k is near standard normal for independent values of any one law.
struct LaggedCorrelation {
  std::size_t lag = 0;
  double correlation = 0;  // r_k
  double z = 0;
};

// All of them; none if n < 8 or all values are equal. Time n K.
std::vector<LaggedCorrelation> lagged_correlations(std::span<const double> values,
                                                   std::size_t first = 2);

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

}  // namespace assay::stats
