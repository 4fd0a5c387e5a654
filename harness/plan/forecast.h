#pragma once

#include <optional>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// What a frozen plan is expected to do, from the pilots.
struct Forecast {
  /// The least theta that the last look finds with probability 1 - beta, of `within` the least
  /// margin that it shows with that probability where theta is 0; the largest over the channels.
  /// nullopt where no formula tells.
  std::optional<double> detectable = {};
  /// Of the last look's secondaries, the share that is drawn on average if theta = 0: an upper
  /// bound. nullopt where a test cannot pass early there or has one look.
  std::optional<double> share = {};
};

/// The share counts a test as open after look k with the least, over the looks j <= k, of the sum
/// over the channels of P(look j does not pass the channel); by the normal law, look j passes when
/// the estimate lies z(beta w_j) standard errors inside the margin.
Forecast forecast(const TestOutcome& test, const Pilots& pilots);

/// Secondaries that a test is expected to take if theta = 0: the last look's where no share is
/// known.
std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots);

/// What the pilots let expect of a channel's data, at this many secondaries: moments scaled to the
/// plan's primaries. nullopt where an estimator has no pilot or no spread in it; recorded data
/// stand in with the mean of what they are compared with.
std::optional<std::vector<ChannelData>> expected_data(const TestOutcome& test, std::size_t channel,
                                                      const Pilots& pilots,
                                                      std::uint64_t secondaries);

}  // namespace assay::harness
