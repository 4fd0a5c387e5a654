#pragma once

// What must hold of the data for a test of them to mean anything.

#include <span>
#include <string>
#include <vector>

#include "harness/outcome.h"
#include "stats/assumption_gates.h"

namespace assay::harness {

/// Gates on the test's own data, of one channel, at the level of the current look; they can only
/// invalidate.
std::vector<reports::Gate> data_gates(const TestOutcome& outcome, std::size_t channel,
                                      std::span<const ChannelData> data);

/// Whether every subject's observations of a channel are the same but for rounding.
bool all_constant(const Question& question, std::size_t channel, std::span<const ChannelData> data);

/// Why a channel of which one sample has no spread cannot be tested: of a variance nothing is
/// known, of a mean what was never seen could decide. "" where it can.
std::string lack_of_spread(const TestOutcome& outcome, std::size_t channel,
                           std::span<const ChannelData> data);

/// Why moments cannot be computed with: the fourth power of the spread is beyond doubles, or what
/// underflows leaves none. "" where they can. Of `name`'s observations, which are not all the same.
std::string beyond_doubles(const stats::Moments& moments, const std::string& name);

reports::Gate gate_of(const stats::Gate& gate, const std::string& where);

}  // namespace assay::harness
