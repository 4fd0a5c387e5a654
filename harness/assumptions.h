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

/// The red gates in words, "" where none is.
std::string red_gates(const std::vector<reports::Gate>& gates);

/// What would turn red gates green: rows of a file, or primaries and secondaries of an estimator.
std::string what_would_help(const TestOutcome& outcome);

/// Whether every subject's observations of a channel are the same but for rounding.
bool all_constant(const Question& question, std::size_t channel, std::span<const ChannelData> data);

/// Why a channel of which one sample has no spread cannot be tested: of a variance nothing is
/// known, of a mean what was never seen could decide. "" where it can.
std::string lack_of_spread(const TestOutcome& outcome, std::size_t channel,
                           std::span<const ChannelData> data);

reports::Gate gate_of(const stats::Gate& gate, const std::string& where);

}  // namespace assay::harness
