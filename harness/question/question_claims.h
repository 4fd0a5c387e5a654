#pragma once

// What claims other than those about means, variances and laws ask. Internal to `ask`.

#include "harness/question/question_sources.h"

namespace assay::harness {

/// E x against the reference + the number claimed: the analytic mean, or what `reference:` names.
Question about_bias(const TestEntry& test, const Estimators& estimators);

/// Rays, samples or seconds (`cost:`) of a primary where the estimator averages, of a secondary
/// estimate otherwise; one number whatever the channels.
Question about_cost(const TestEntry& test, const Estimators& estimators);

/// 1 / (error x cost): error is the variance, or the mean squared error where an estimator is
/// biased by its class or the test names a `reference`.
Question about_efficiency(const TestEntry& test, const Estimators& estimators);

Question about_quantile(const TestEntry& test, const Estimators& estimators);

/// The variances of all channels, added.
Question about_total_variance(const TestEntry& test, const Estimators& estimators);

/// What a sampler's density integrates to, or how often its draws contradict it.
Question about_draws(const TestEntry& test, const Estimators& estimators);

/// The exponent s of a quantity that goes like (swept parameter)^s; a subject a point.
Question about_slope(const TestEntry& test, const Estimators& estimators);

/// The largest variance of several channels is claimed to be at most or below a number: that each
/// channel's is. InputError for any other claim on several channels.
void check_worst_variance(const Claim& claim, const Estimators& estimators);

}  // namespace assay::harness
