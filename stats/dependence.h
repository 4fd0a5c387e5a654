#pragma once

#include <cstddef>
#include <span>

#include "stats/moments.h"
#include "stats/student_t.h"
#include "stats/test_result.h"

namespace assay::stats {

// Samples in the order in which they were made. Throughout, c_k = (1/n) sum_(t > k) (x_t - mean)
// (x_(t-k) - mean) and r_k = c_k / c_0.

// r_lag. Throws std::domain_error (lag >= n, non-finite values), ZeroVariance.
double autocorrelation(std::span<const double> values, std::size_t lag);

// Null hypothesis: independent values of one law.
//   Z = (r_1 + 1/n) / sqrt(V),  V = (n^4 - 4 n^3 + 3 n^2 + 4 n - 4) / ((n + 1) n^2 (n - 1)^2)
// referred to the normal law: mean and variance of r_1 exact for normal data (Dufour & Roy 1985,
// J. Econometrics 29), to first order for any law with a variance (Anderson & Walker
// 1964). log_p_upper is the tail of positive correlation. Throws for n < 4; ZeroVariance.
TestResult lag_one_test(std::span<const double> values);

// Null hypothesis: independent values. Q = n (n + 2) sum_(k <= lags) r_k^2 / (n - k), chi-square
// with `lags` degrees of freedom (Ljung & Box 1978, Biometrika 65). Throws for lags = 0 or lags >=
// n.
TestResult ljung_box(std::span<const double> values, std::size_t lags);

// Effective sample size n / tau, tau = -1 + 2 sum Gamma_m, Gamma_m = r_2m + r_(2m+1) summed while
// positive and made monotone (Geyer 1992, Stat. Sci. 7, section 3.3). Of independent values about
// n, of an AR(1) chain n (1 - phi) / (1 + phi). May exceed n for alternating sequences; at most
// n log10 n (Vehtari et al. 2021, Bayesian Anal. 16). Time n tau. Throws for n < 4; ZeroVariance.
double effective_sample_size(std::span<const double> values);

// floor(sqrt n), the default length of a batch.
std::size_t default_batch(std::size_t n);
// The moments of the means of floor(n / length) whole batches; the rest at the end is left out.
// Throws std::domain_error for fewer than two batches or length 0.
Moments batch_means(std::span<const double> values, std::size_t length);

// Null hypothesis: E x = null_mean.value, for a stationary sequence: student_t on the batch means,
// degrees of freedom (batches - 1) before the reference's error. Asymptotic; needs batches of about
// ten integrated autocorrelation times tau and at least 20 of them (Glynn & Iglehart 1990).
struct BatchedMean {
  TestResult result;
  std::size_t length = 0;
  bool enough = false;  // length >= 10 n / effective_sample_size and batches >= 20
};
BatchedMean batch_means_t(std::span<const double> values, Reference null_mean, std::size_t length);

// lim n Var(mean): length times the variance of batch means, and the lugsail estimate
// 2 v(length) - v(length / 3), which leans to the safe side where correlation is positive (Vats &
// Flegal 2022, Biometrika 109, with r = 3, c = 1/2). length / 3 is rounded down, hence
// length >= 3. The lugsail estimate can be negative by chance.
double batch_variance(std::span<const double> values, std::size_t length);
double lugsail_variance(std::span<const double> values, std::size_t length);

}  // namespace assay::stats
