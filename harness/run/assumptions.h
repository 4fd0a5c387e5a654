#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/plan/outcome.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// Gates on one channel's data at the level of the current look. They can only invalidate.
std::vector<Gate> data_gates(const TestOutcome& outcome, std::size_t channel,
                             std::span<const ChannelData> data);

/// Why a channel with a constant sample cannot be tested, or "". A variance is unknown then, and
/// unseen values could decide about a mean.
std::string lack_of_spread(const TestOutcome& outcome, std::size_t channel,
                           std::span<const ChannelData> data);

}  // namespace assay::harness
