#pragma once

#include <cstdint>

#include "stats/means/student_t.h"

namespace assay::stats {

// A sample without spread: `count` independent values, all equal to `value`, of a law on
// [low, high] (either end may be infinite).
struct ConstantSample {
  double value = 0;
  double low = 0;
  double high = 0;
  std::uint64_t count = 0;
};

// Null hypothesis: E x = m, where m is known as reference.value, or as a normal estimate of that
// standard error. ln of its p-value, two-sided.
//
// What was never seen may make up the difference: E x = value + s, s > 0, needs P(x != value) >=
// s / (high - value), so that P(all are `value`) <= (1 - s / (high - value))^count, exact; below
// likewise with value - low. With d = |reference.value - value|:
//   error 0:   p <= (1 - d / reach)^count
//   otherwise  p <= 2 sup over 0 <= s <= d of (1 - s / reach)^count Phi(-(d - s) / error),
// the sup of a log-concave function. 1 for d = 0 and for an infinite reach; the most negative
// finite double stands for probability zero.
// Throws std::domain_error: count 0, a non-finite value or reference, a negative error, a value
// outside its range.
double log_p_constant(const ConstantSample& sample, const Reference& reference);

}  // namespace assay::stats
