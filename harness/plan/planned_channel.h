#pragma once

// What planning takes a channel to be.

#include <cstdint>

#include "harness/theta/decision.h"
#include "harness/theta/family.h"
#include "stats/means/bounded_mean.h"

namespace assay::harness {

/// What planning takes a channel's law to be: a secondary's standard deviation and kurtosis at the
/// upper limit of what the pilot allows, and the value margins are relative to.
struct PlannedChannel {
  Regions regions = {};
  double standard_deviation = 0;
  double other_deviation = 0;  ///< of the second subject, times the factor
  double kurtosis = 3;
  double other_kurtosis = 1;  ///< 1: there is no second subject
  double unit = 1;            ///< theta times this is in the estimator's unit
  double reference_error = 0;
  bool unseen = false;      ///< the deviation is what a pilot without spread may not have seen
  stats::Range range = {};  ///< of one mean: what its values are declared to lie in
  double null_value = 0;    ///< of one mean: where theta is 0
};

/// A look of a test, at its levels: secondaries of each subject, or all that it has.
struct TestSize {
  ErrorShare share;
  std::uint64_t secondaries;
};

/// More secondaries than any test is given: what is planned beyond is impossible.
inline constexpr std::uint64_t impossible_secondaries = std::uint64_t{1} << 53;

}  // namespace assay::harness
