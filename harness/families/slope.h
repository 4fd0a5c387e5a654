#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/theta/gate.h"
#include "harness/theta/methods.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Theta is the exponent minus the claimed one. Biases and means are fitted as they are, variances
/// and costs by their logarithms (stats/variances/slope.h). Costs that never vary are exact.
Evidence evidence_of_slope(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data);

inline bool of_costs(const Question& question) {
  return question.test->claim.left.row->counts_cost;
}

/// Gates of the points whose logarithms are fitted, on the skewness of their influence values.
std::vector<Gate> skewness_gates(const Question& question, std::size_t channel,
                                 std::span<const ChannelData> data, double critical);

/// Checks that the points lie on a power law, by p of the slope that fits best. The gate is red up
/// to max(`level`, 1e-5); `level` is the largest at which a verdict rejects a slope. A red gate
/// leaves no slope: to reject all others neither shows nor refutes a claim. Under a power law it is
/// red with at most this probability.
Gate power_law_gate(const Question& question, std::size_t channel,
                    std::span<const ChannelData> data, double level);

/// Why the points of a sweep cannot be fitted: one has no spread, so its error is unknown. Empty if
/// all have. Costs that never vary are exact.
std::string point_without_spread(const Question& question, std::size_t channel,
                                 std::span<const ChannelData> data);

}  // namespace assay::harness
