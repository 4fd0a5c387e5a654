#pragma once

#include <cstdint>

#include "stats/basics/moments.h"
#include "stats/gates/assumption_gates.h"

namespace assay::stats {

// Gates of the mean of a sample without a pilot. They are stricter than skewness_gate. A skewed law
// fails a true claim exactly by the samples that miss its tail, and those look less skewed than
// they are. No gate can see a tail to which nothing in the sample points (a contribution of
// probability 1/n).

// The fewest values whose skewness tells anything at critical value x: max(50, 6 x^3). It is
// multiplied by the cube of `variance_share`, the sample's share of the variance of a contrast.
// (Its share in 2a of skewness_gate goes like share^1.5 / sqrt n.) At least 2. With fewer values,
// normal and exponential samples look alike before the t test's level is off.
std::uint64_t fewest_unpiloted(double critical_value, double variance_share = 1);

// The same as a gate. Value: count, limit: the fewest; red below it.
Gate unpiloted_count_gate(const Moments& x, double critical_value, double variance_share = 1);

// Value: |g1| / sqrt n, the skewness of the mean. Limit: the larger of min(.15, .4 / x) and the
// quantile that normal data exceed with probability 5e-5 (D'Agostino 1970). Red above it. Throws
// std::domain_error: count < 2, critical value not positive; ZeroVariance.
Gate unpiloted_skewness_gate(const Moments& x, double critical_value);
// The same for the contrast mean x - scale mean y: |sum psi^3| / (sum psi^2)^1.5.
Gate unpiloted_skewness_gate(const Moments& x, const Moments& y, double scale,
                             double critical_value);

}  // namespace assay::stats
