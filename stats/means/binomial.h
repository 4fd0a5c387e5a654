#pragma once

#include <cstdint>

#include "stats/tails/test_result.h"

namespace assay::stats {

struct Successes {
  std::uint64_t successes = 0;
  std::uint64_t trials = 0;
};

// Null hypothesis: P(success) = null_probability. Exact binomial tails. They are discrete, so P(p
// <= a) <= a. Throws std::domain_error: no trials, successes > trials, probability outside [0, 1].
TestResult binomial(Successes observed, double null_probability);

// Clopper & Pearson (1934): central interval of P(success), coverage at least `confidence`.
Interval clopper_pearson(Successes observed, double confidence);

}  // namespace assay::stats
