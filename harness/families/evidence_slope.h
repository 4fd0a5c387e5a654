#pragma once

#include <span>
#include <string>

#include "harness/theta/method.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Theta is the exponent minus the claimed one. Biases and means are fitted as they are, variances
/// and costs by their logarithms (stats/slope.h); costs that never vary are compared exactly.
Evidence evidence_of_slope(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data);

/// Whether the points lie on a power law at all: p of the slope that fits best, red below 1e-5 and
/// up to `level`, the largest that a verdict rejects a slope at. Where it is red no slope is left
/// there, and a claim about one is neither shown nor refuted by rejecting all others. Under a power
/// law it is red with probability `level` at most.
reports::Gate power_law_gate(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data, double level);

/// Why the points of a sweep cannot be fitted: one of them has no spread, so that its error is
/// unknown; "" where all have. Costs that never vary are exact.
std::string point_without_spread(const Question& question, std::size_t channel,
                                 std::span<const ChannelData> data);

}  // namespace assay::harness
