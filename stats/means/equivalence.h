#pragma once

#include "stats/tails/test_result.h"

namespace assay::stats {

// Two one-sided tests (Schuirmann 1987). Null hypothesis: theta <= low or theta >= high. p = max(p
// of "theta <= low", p of "theta >= high"). Two tests need no factor: P(p <= a) <= a.
struct Equivalence {
  TestResult at_low;
  TestResult at_high;
  double log_p = 0;
};

// Any pair of results of one method, at the two null values.
Equivalence equivalence(const TestResult& at_low, const TestResult& at_high);

}  // namespace assay::stats
