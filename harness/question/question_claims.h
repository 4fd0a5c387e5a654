#pragma once

// Binds claims other than those about means, variances and laws. Internal to `ask`.

#include "harness/question/question_sources.h"

namespace assay::harness {

/// E x against reference + number. The reference is the analytic mean, or that of `reference:`.
Question about_bias(const TestEntry& test, const Estimators& estimators);

/// Rays, samples or seconds (`cost:`), one number for all channels. They are those of a primary if
/// the estimator averages, else those of a secondary.
Question about_cost(const TestEntry& test, const Estimators& estimators);

/// 1 / (error x cost). The error is the variance, or the mean squared error if the estimator is
/// biased by its class or the test names a `reference`.
Question about_efficiency(const TestEntry& test, const Estimators& estimators);

Question about_quantile(const TestEntry& test, const Estimators& estimators);

Question about_total_variance(const TestEntry& test, const Estimators& estimators);

/// The integral of a sampler's density, or how often its draws contradict it.
Question about_draws(const TestEntry& test, const Estimators& estimators);

/// The exponent s of a quantity that goes like (swept parameter)^s; each subject is a point.
Question about_slope(const TestEntry& test, const Estimators& estimators);

/// Allows "at most" and "below" for the largest variance of several channels: every channel's is
/// bounded then. InputError for any other claim on several channels.
void check_worst_variance(const Claim& claim, const Estimators& estimators);

}  // namespace assay::harness
