#pragma once

#include <string>

#include "harness/outcome.h"

namespace assay::harness {

/// What a tested claim's verdict means in one or two sentences: what was found, what was excluded,
/// what could have been missed, or how many more samples would decide.
std::string narrate(const TestOutcome& outcome);

/// The same of a claim that only Holm's adjustment over the suite refutes, by this channel.
std::string narrate_holm(const TestOutcome& outcome, const ChannelOutcome& channel);

}  // namespace assay::harness
