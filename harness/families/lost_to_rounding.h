#pragma once

#include <span>
#include <string>

#include "harness/theta/method.h"

namespace assay::harness {

/// Why means cannot be compared: what rounding adds to them is more than a tenth of the
/// comparison's standard error, as of values of 1e14 that spread over 1. "" where it is less.
std::string lost_to_rounding(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data);

/// Why the sum of these channels' variances cannot be tested: what rounding adds to the sums of an
/// observation's primaries makes it larger by more than a tenth of its standard error, the
/// channels' errors taken for independent. "" where it is less.
std::string variances_lost_to_rounding(const Subject& side, std::uint64_t primaries,
                                       std::span<const stats::Moments> channels);

}  // namespace assay::harness
