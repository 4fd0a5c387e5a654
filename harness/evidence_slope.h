#pragma once

#include <span>

#include "harness/method.h"
#include "reports/record.h"

namespace assay::harness {

/// Theta is the exponent minus the claimed one. Biases and means are fitted as they are, variances
/// and costs by their logarithms (stats/slope.h); costs that never vary are compared exactly.
Evidence evidence_of_slope(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data);

/// Whether the points lie on a power law at all: ln p of the fit, red below 1e-5.
reports::Gate power_law_gate(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data);

}  // namespace assay::harness
