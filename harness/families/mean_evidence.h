#pragma once

// Evidence about means: the same contrasts, tested by the method that was chosen.

#include <span>

#include "harness/theta/method.h"
#include "stats/means/bounded_mean.h"

namespace assay::harness {

// Of a claimed bias b (question.offset), E x - b takes the place of E x.

/// theta = (E x - r) / |r| where margins are relative, else E x - r. `values` are read by `betting`
/// alone, which takes the channel's declared lower bound and sees one direction.
Evidence mean_against_number(const Method& method, const Question& question, std::size_t channel,
                             const stats::Moments& x, std::span<const double> values = {});

/// theta = (E x - c E y) / |c E y| where margins are relative, tested as a contrast, else E x - c E
/// y.
Evidence mean_against_mean(const Method& method, const Question& question, std::size_t channel,
                           std::span<const ChannelData> data);

/// The values a channel is declared to lie between; of recorded data the smallest and the largest.
stats::Range range_of(const Question& question, std::size_t subject, std::size_t channel,
                      const stats::Moments& moments);

}  // namespace assay::harness
