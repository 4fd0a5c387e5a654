#pragma once

// Evidence about means: the same contrasts, tested by the chosen method.

#include <span>
#include <string>

#include "harness/theta/methods.h"

namespace assay::harness {

// theta = E x - r, or (E x - r) / |r| if margins are relative. For two estimators c E y replaces r,
// and the relative difference is tested as a contrast. A claimed bias b (question.offset) is
// subtracted from E x.

/// Student's and Welch's t.
Evidence mean_by_t(const Method&, const Question&, std::size_t channel,
                   std::span<const ChannelData>);
/// Both with Hall's correction for skewness.
Evidence mean_by_corrected_t(const Method&, const Question&, std::size_t channel,
                             std::span<const ChannelData>);
/// Exact, for values at the two ends of a range.
Evidence mean_of_two_values(const Method&, const Question&, std::size_t channel,
                            std::span<const ChannelData>);
/// Exact, for values in declared ranges. Keeps the values.
Evidence mean_by_bets(const Method&, const Question&, std::size_t channel,
                      std::span<const ChannelData>);

/// Why means cannot be compared: rounding adds more than a tenth of the comparison's standard
/// error. Empty if it adds less.
std::string lost_to_rounding(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data);

}  // namespace assay::harness
