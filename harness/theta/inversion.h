#pragma once

#include <functional>

#include "stats/tails/test_result.h"

namespace assay::harness {

/// Where an interval lies, roughly.
struct Whereabouts {
  double estimate = 0;
  double step = 1;  ///< about a standard error
};

/// The values of theta that `at` rejects in neither tail at (1 - confidence) / 2 each, to a
/// relative error of 1e-12 of the step; an end that 60 doublings of the step do not reach is
/// infinite. `at` must be monotone: larger values less rejected by its upper tail.
stats::Interval interval_by_inversion(const std::function<stats::TestResult(double)>& at,
                                      const Whereabouts& around, double confidence);

}  // namespace assay::harness
