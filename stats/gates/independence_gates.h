#pragma once

#include <cstddef>
#include <span>

#include "stats/gates/assumption_gates.h"

namespace assay::stats {

// Gates of independence for values in the order in which they were made. On independent normal
// values each is red with probability 5e-5.

// Value: r_1 (dependence.h), the correlation of neighbours; limit: the r_1 at which lag_one_test
// has the two-sided p-value 5e-5; green up to that of .01. Sees what changes from value to value: a
// Markov chain, sorted values, antithetic pairs. Throws as lag_one_test.
Gate lag_one_gate(std::span<const double> values);

// Value: n_b Var(batch means) / Var within batches, batches of floor(sqrt n), the rest at the end
// left out: about the integrated autocorrelation time once that is long, 1 for independent values.
// Under independence and normality exactly F with (batches - 1, batches (length - 1)) degrees of
// freedom (one-way analysis of variance); limit: its upper quantile at 5e-5, green up to that at
// .01. Sees drifts and slow chains that lag one does not. Throws std::domain_error for n < 9;
// ZeroVariance.
Gate batch_gate(std::span<const double> values);

// Value: the rank correlation of values some steps apart (lagged_correlation.h) that is farthest
// from 0, over lags 2 to K; limit: what its z is at 5e-5 / (K - 1), two-sided. Sees chains that
// take turns in a file. Green where there are no such lags.
Gate lagged_gate(std::span<const double> values);

// n Var(mean) / Var x, the integrated autocorrelation time, by effective_sample_size; of more than
// 8192 values from the means of neighbours, which have the same n Var(mean).
double autocorrelation_time(std::span<const double> values);
// By what the variance of a mean of n independent values is to be multiplied where a dependence too
// weak for the gates may be: 1, or where the z of r_1, or the F of batches of floor(sqrt n) or n /
// 10 is beyond what independent values exceed with probability .05, the larger of
// autocorrelation_time and that F. Of pairs of 100 values of AR(1) chains with phi = .3 some 4.3 %
// pass the gates and yet have means that differ at .01, with it 1.2 %; a slow chain under noise it
// halves at best (.23 to .11 of 200 values with phi = .95 and nine parts of noise). Throws as
// batch_gate.
double allowance_for_dependence(std::span<const double> values);
// The length of a batch that is long enough for batch_means: the largest of default_batch, ten
// autocorrelation times, rounded up, and five times the farthest lag with a positive rank
// correlation that is beyond chance for values with such a time (chains that take turns correlate
// at their number, where the time, which sums from neighbours on, has stopped); and so much longer
// that less than a batch is left over.
std::size_t sufficient_batch(std::span<const double> values);

}  // namespace assay::stats
