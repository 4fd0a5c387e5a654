#pragma once

// What must hold of the data for a test of them to mean anything.

#include <span>
#include <string>
#include <vector>

#include "harness/plan/outcome.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// Gates on the test's own data, of one channel, at the level of the current look; they can only
/// invalidate.
std::vector<reports::Gate> data_gates(const TestOutcome& outcome, std::size_t channel,
                                      std::span<const ChannelData> data);

/// Why a channel of which one sample has no spread cannot be tested: of a variance nothing is
/// known, of a mean what was never seen could decide. "" where it can.
std::string lack_of_spread(const TestOutcome& outcome, std::size_t channel,
                           std::span<const ChannelData> data);

}  // namespace assay::harness
