#pragma once

#include "stats/tails/test_result.h"

namespace assay::stats {

// An estimate that is normal about theta, in the limit, and its standard error.
struct NormalEstimate {
  double value = 0;
  double standard_error = 1;
};

// Null hypothesis: theta = 0 (<= 0, >= 0), by z = value / standard_error. Asymptotic.
TestResult normal_test(NormalEstimate estimate);

}  // namespace assay::stats
