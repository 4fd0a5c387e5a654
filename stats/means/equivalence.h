#pragma once

#include "stats/means/student_t.h"
#include "stats/means/welch_t.h"

namespace assay::stats {

// The forbidden region is outside (low, high).
struct Margins {
  double low = 0;
  double high = 0;
};

// Two one-sided tests (Schuirmann 1987). Null hypothesis: theta <= low or theta >= high. p = max(p
// of "theta <= low", p of "theta >= high"). Two tests need no factor: P(p <= a) <= a.
struct Equivalence {
  TestResult at_low;
  TestResult at_high;
  double log_p = 0;
};

// Any pair of results of one method, at the two null values.
Equivalence equivalence(const TestResult& at_low, const TestResult& at_high);

// theta = E x - reference.value. Throws as student_t, and when margins.low >= margins.high.
Equivalence student_t_equivalence(const Moments& x, Reference reference, Margins margins);
// theta = E x - E y.
Equivalence welch_equivalence(const Moments& x, const Moments& y, Margins margins);
// theta = E x / E y - 1, tested as the contrasts E x - (1 + margin) E y. That is for E y > 0. If
// mean y < 0 the two margins exchange their roles.
Equivalence welch_relative_equivalence(const Moments& x, const Moments& y, Margins margins);

}  // namespace assay::stats
