#pragma once

#include <span>
#include <string>

#include "harness/method.h"

namespace assay::harness {

/// Why means cannot be compared: what rounding adds to them is more than a tenth of the
/// comparison's standard error, as of values of 1e14 that spread over 1. "" where it is less.
std::string lost_to_rounding(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data);

/// Why variances cannot be tested: what rounding adds to the sum of an observation's primaries
/// makes one larger by more than a tenth of the standard error of its logarithm. "" where it is
/// less.
std::string variance_lost_to_rounding(const Question& question, std::span<const ChannelData> data);

}  // namespace assay::harness
