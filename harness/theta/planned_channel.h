#pragma once

#include <cstdint>
#include <memory>

#include "harness/theta/decision.h"
#include "stats/means/betting_mean.h"

namespace assay::harness {

/// A channel's law as planning takes it: a secondary's standard deviation, at the pilot's upper
/// limit, and the unit of margins. A ratio has the deviations of relative influence values.
struct PlannedChannel {
  Regions regions = {};
  double standard_deviation = 0;
  double other_deviation = 0;  ///< The second subject's, times the factor.
  double unit = 1;             ///< Theta times this is in the estimator's unit.
  double reference_error = 0;
  bool unseen = false;      ///< The deviation is what a constant pilot may have missed.
  stats::Range range = {};  ///< Declared range of one mean's values.
  double null_value = 0;    ///< The value of one mean where theta is 0.
  std::shared_ptr<const stats::ValueCells> law = {};  ///< Values of a secondary, for bets.
};

/// A look's levels, and its secondaries of each subject, or all that it has.
struct TestSize {
  ErrorShare share;
  std::uint64_t secondaries;
};

/// More secondaries than any test is given: a larger plan is impossible.
inline constexpr std::uint64_t impossible_secondaries = std::uint64_t{1} << 53;

}  // namespace assay::harness
