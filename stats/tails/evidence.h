#pragma once

#include <functional>
#include <limits>
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

// Tests of a distance theta >= 0. The upper p-value of `at` rises with theta, and the lower one
// falls.
struct DistanceTest {
  std::string quantity;
  double estimate = 0;
  TestResult equal;                      // Tests theta = 0.
  std::function<TestResult(double)> at;  // Tests a theta from 0 to the largest.
  double start = 1;                      // Ends of intervals are sought from here on.
  double largest = 1e12;
  double beyond = std::numeric_limits<double>::infinity();  // The end where no theta is too large.
};

// Its interval is central, from 0 on. Both ends are NaN if the lower tail rejects even 0: such data
// are closer than chance allows.
Evidence distance_evidence(const DistanceTest& test);

// Evidence about |theta|, a distance.
Evidence absolute(const Evidence& of_theta);

}  // namespace assay::stats
