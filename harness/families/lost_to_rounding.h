#pragma once

#include <span>
#include <string>

#include "harness/theta/method.h"

namespace assay::harness {

/// Why means cannot be compared: rounding adds more than a tenth of the comparison's standard
/// error. Empty if it adds less.
std::string lost_to_rounding(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data);

/// Why the sum of these channels' variances cannot be tested: rounding of an observation's sums
/// enlarges it by over a tenth of its standard error. The channels' errors count as independent.
/// Empty if it adds less.
std::string variances_lost_to_rounding(const Subject& side, std::uint64_t primaries,
                                       std::span<const stats::Moments> channels);

/// Why a channel's variance cannot be tested: a sample without spread, or lost to rounding; "" if
/// it can.
std::string lack_of_variance(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data);

}  // namespace assay::harness
