#pragma once

// What the data say about theta, the number a claim is about, whatever the method: a test of any
// value of theta, in both directions, and an interval. Verdicts are made of nothing else.

#include <functional>
#include <string>
#include <utility>

#include "stats/tails/test_result.h"

namespace assay::harness {

struct Evidence {
  double estimate = 0;  ///< of theta
  /// Tests "theta is this value": log_p_upper is the p-value of "theta <= value", log_p_lower that
  /// of "theta >= value".
  std::function<stats::TestResult(double)> at;
  /// Two-sided interval of theta.
  std::function<stats::Interval(double)> interval;
  /// Which part of the data speaks most against "theta <= this value", in words; unset where the
  /// data have no parts.
  std::function<std::string(double)> most_against = {};
  std::string quantity;   ///< what theta is, in words
  bool relative = false;  ///< shown in per cent
  bool ratio = false;     ///< theta is the logarithm of a ratio
  bool distance = false;  ///< theta cannot be negative: `==` has one direction
  bool exact = false;     ///< theta is the estimate, without an error: costs that never vary
};

/// A part that is the same for every value.
inline std::function<std::string(double)> always(std::string part) {
  return [part = std::move(part)](double) { return part; };
}

}  // namespace assay::harness
