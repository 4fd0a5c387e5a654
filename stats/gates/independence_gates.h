#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/gates/assumption_gates.h"

namespace assay::stats {

// Gates of independence, for values in the order in which they were made. On independent normal
// values each is red with probability 5e-5.

// Value: r_1 (dependence.h), the correlation of neighbours. Limit: the r_1 at which lag_one_test
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

// Value: the rank correlation (dependence.h) that is farthest from 0, over lags 2 to K.
// Limit: its value at z of 5e-5 / (K - 1), two-sided. Sees chains that take turns in a file. Green
// if there are no such lags.
Gate lagged_gate(std::span<const double> values);

// Null hypothesis: what an estimator draws is independent, of any one law. Two gates rest on ranks,
// whose law is that of a random order, whatever the values. Each is red with probability 1e-7 at
// most, and amber below .01. A third stands there, red, if a run of values comes again (copies.h),
// as from seeds that do. Below 8 values there are none.
//
// The first has the rank correlation r_k that is farthest from 0, over the lags k = 1 ... K of the
// first 2048 values (dependence.h). The second has the largest `H / B`, over
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
