#pragma once

#include <optional>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// Expected behaviour of a frozen plan, from the pilots.
struct Forecast {
  /// The least theta that the last look finds with probability 1 - beta; for `within` the least
  /// margin that it proves if theta is 0. The largest over the channels; nullopt if no formula
  /// tells.
  std::optional<double> detectable = {};
  /// Upper bound on the mean part of the last look's secondaries that is drawn if theta is 0. It is
  /// nullopt with one look, or if no early pass is possible.
  std::optional<double> share = {};
};

/// P(open after look k) counts as a minimum over j <= k: the channels' summed P(look j does not
/// pass). By the normal law look j passes if the estimate lies z(beta w_j) standard errors inside
/// the margin.
Forecast forecast(const TestOutcome& test, const Pilots& pilots);

/// Expected secondaries of a test if theta is 0; the last look's if no share is known.
std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots);

/// Data that the pilots predict for a channel at this many secondaries: moments scaled to the
/// plan's primaries. Returns nullopt if an estimator has no pilot, or no spread in it. Recorded
/// data take the mean of what they are compared with.
std::optional<std::vector<ChannelData>> expected_data(const TestOutcome& test, std::size_t channel,
                                                      const Pilots& pilots,
                                                      std::uint64_t secondaries);

}  // namespace assay::harness
