#pragma once

#include <functional>

#include "stats/tails/test_result.h"

namespace assay::harness {

/// A rough location of an interval.
struct Whereabouts {
  double estimate = 0;
  double step = 1;  ///< About a standard error.
};

/// The values of theta that `at` rejects in neither tail at (1 - confidence) / 2. The ends are
/// exact to 1e-12 of the step. An end beyond 60 doublings of the step is infinite. `at` must be
/// monotone: its upper tail rejects larger values less.
stats::Interval interval_by_inversion(const std::function<stats::TestResult(double)>& at,
                                      const Whereabouts& around, double confidence);

/// The interval of a monotone function of the number, rising or falling.
stats::Interval map_ends(const stats::Interval& interval, const std::function<double(double)>& map);

}  // namespace assay::harness
