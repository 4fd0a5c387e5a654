#pragma once

// Evidence about means: the same contrasts, tested by the method that was chosen.

#include <span>

#include "harness/theta/method.h"
#include "stats/means/bounded_mean.h"

namespace assay::harness {

// theta = (E x - r) / |r| where margins are relative, else E x - r. Of two estimators it is
// (E x - c E y) / |c E y|, tested as a contrast, or E x - c E y. Of a claimed bias b
// (question.offset), E x - b takes the place of E x.

/// Student's and Welch's t.
Evidence mean_by_t(const Method&, const Question&, std::size_t channel,
                   std::span<const ChannelData>);
/// Both with Hall's correction for skewness.
Evidence mean_by_corrected_t(const Method&, const Question&, std::size_t channel,
                             std::span<const ChannelData>);
/// Exact, of values that are the ends of a range alone.
Evidence mean_of_two_values(const Method&, const Question&, std::size_t channel,
                            std::span<const ChannelData>);
/// Exact, of values in a declared range; one estimator.
Evidence mean_in_a_range(const Method&, const Question&, std::size_t channel,
                         std::span<const ChannelData>);
/// "E x <= r" by bets on what lies above the declared lower bound; nothing refutes the contrary.
Evidence mean_by_bets(const Method&, const Question&, std::size_t channel,
                      std::span<const ChannelData>);

/// The values a channel is declared to lie between; of recorded data the smallest and the largest.
stats::Range range_of(const Question& question, std::size_t subject, std::size_t channel,
                      const stats::Moments& moments);

}  // namespace assay::harness
