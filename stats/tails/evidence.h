#pragma once

#include <functional>
#include <string>

#include "stats/tails/test_result.h"

namespace assay::stats {

// Evidence about a number theta: a test of every value in both directions, and an interval.
struct Evidence {
  double estimate = 0;
  // Tests "theta is this value". log_p_upper is the p-value of "theta <= value", log_p_lower that
  // of "theta >= value".
  std::function<TestResult(double)> at;
  // Two-sided interval of theta.
  std::function<Interval(double)> interval;
  // The part of the data that speaks most against "theta <= value", in words. Unset if the data
  // have no parts.
  std::function<std::string(double)> most_against = {};
  std::string quantity = "";  // Name of theta.
  bool relative = false;      // Shown in per cent.
  bool distance = false;      // Theta cannot be negative: `==` has one direction.
  bool exact = false;         // The estimate has no error, as with costs that never vary.
};

// Evidence about |theta|, a distance.
Evidence absolute(const Evidence& of_theta);

}  // namespace assay::stats
