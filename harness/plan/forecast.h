#pragma once

#include <optional>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// Probabilities of the verdicts at one theta, and the mean part of the last look that is drawn.
struct Outlook {
  double pass = 0;
  double fail = 0;
  double inconclusive = 0;
  double invalid = 0;  ///< Only what the pilot shows.
  double drawn = 1;
};

/// Expected behaviour of a frozen plan, from the pilots.
struct Forecast {
  /// The least theta that the last look finds with probability 1 - beta; for `within` the least
  /// margin that it proves if theta is 0. The largest over the channels; nullopt if no formula
  /// tells.
  std::optional<double> detectable = {};
  /// Theta is 0 in every channel; for `<` and `>` the claim holds by `detect`.
  std::optional<Outlook> if_true = {};
  /// Theta is at the edge of the forbidden region, in the channel that passes most often.
  std::optional<Outlook> if_off = {};
};

/// The outlooks follow from the joint normal law of the looks' scores. A method that bets has none.
/// Several channels are counted as if never two of them failed together.
Forecast forecast(const TestOutcome& test, const Pilots& pilots);

/// Expected secondaries of a test whose claim holds; the last look's if that is not known.
std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots);

/// Data that the pilots predict for a channel at this many secondaries: moments scaled to the
/// plan's primaries. Returns nullopt if an estimator has no pilot, or no spread in it. Recorded
/// data take the mean of what they are compared with.
std::optional<std::vector<ChannelData>> expected_data(const TestOutcome& test, std::size_t channel,
                                                      const Pilots& pilots,
                                                      std::uint64_t secondaries);

}  // namespace assay::harness
