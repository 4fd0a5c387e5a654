#pragma once

#include <functional>

#include "stats/tails/test_result.h"

namespace assay::stats {

// A rough location of an interval.
struct Whereabouts {
  double estimate = 0;
  double step = 1;  // About a standard error.
};

// The values of theta that `at` rejects in neither tail at (1 - confidence) / 2. The ends are exact
// to 1e-12 of their distance from the estimate. An end beyond 60 doublings of the step is infinite.
// `at` must be monotone: its upper tail rejects larger values less.
Interval interval_by_inversion(const std::function<TestResult(double)>& at,
                               const Whereabouts& around, double confidence);

// The interval of a monotone function of the number, rising or falling.
Interval map_ends(const Interval& interval, const std::function<double(double)>& map);

}  // namespace assay::stats
