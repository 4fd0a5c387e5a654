#pragma once

#include <optional>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "stats/planning/boundary.h"

namespace assay::harness {

/// Expected behaviour of a frozen plan, from the pilots.
struct Forecast {
  /// The least theta that the last look finds with probability 1 - beta; for `within` the least
  /// margin that it proves if theta is 0. The largest over the channels; nullopt if no formula
  /// tells.
  std::optional<double> detectable = {};
  /// Theta is 0 in every channel; for `<` and `>` the claim holds by `detect`.
  std::optional<stats::Outlook> if_true = {};
  /// Theta is at the edge of the forbidden region, in the channel that passes most often.
  std::optional<stats::Outlook> if_off = {};
};

/// The outlooks follow from the joint normal law of the looks' scores. A method that bets has none.
Forecast forecast(const TestOutcome& test, const Pilots& pilots);

/// The cost of an observation.
struct PilotedCost {
  double rays = 0;
  double samples = 0;
  double seconds = 0;  ///< of CPU time
};

/// By the subject's pilot, of which averages are nearer to an observation. A sampler's draw takes
/// the time of a primary of its estimator, and no rays. nullopt without a pilot.
std::optional<PilotedCost> observation_cost(const Subject& subject, std::uint64_t primaries,
                                            const Pilots& pilots);

/// Expected secondaries of a test whose claim holds; the last look's if that is not known.
std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots);

}  // namespace assay::harness
