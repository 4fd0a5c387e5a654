#pragma once

#include <cstdint>

#include "stats/basics/moments.h"
#include "stats/means/student_t.h"

namespace assay::stats {

// A sample without spread: `count` independent values, all equal to `value`. Their law lives on
// [low, high]; either end may be infinite.
struct ConstantSample {
  double value = 0;
  double low = 0;
  double high = 0;
  std::uint64_t count = 0;
};

// ln p, two-sided. Null hypothesis: E x = m. Here m is reference.value, or is known by it as a
// normal estimate of that standard error.
//
// Unseen values may make up the difference. E x = value + s with s > 0 needs P(x != value) >= s /
// (high - value). So P(all are `value`) <= (1 - s / (high - value))^count, exactly. Below it is
// likewise with value - low. Let d = |reference.value - value|. With error 0 p is at most (1 - d /
// reach)^count. Otherwise it is at most
//   2 sup over 0 <= s <= d of (1 - s / reach)^count Phi(-(d - s) / error).
// The function under the sup is log-concave. p is 1 for d = 0 and for an infinite reach. The most
// negative finite double stands for probability zero. Throws std::domain_error: count 0, a
// non-finite value or reference, a negative error, a value outside its range.
double log_p_constant(const ConstantSample& sample, const Reference& reference);

// The same of two such samples. Null hypothesis: E a = E b. Unseen values of either may make up
// parts of the difference. With d = |b.value - a.value|, and reaches r toward the other value, p is
// the sup over 0 <= s <= d of (1 - s / ra)^na (1 - (d - s) / rb)^nb. Throws as above.
double log_p_constants(const ConstantSample& a, const ConstantSample& b);

// The reach of values x that a constant c may have missed, if they are as these others:
// sqrt(E (x - c)^4 / E (x - c)^2). Rare large ones tell it. It is infinite if all others are c.
// Throws std::domain_error for no values.
double size_about(double constant, const Moments& others);

}  // namespace assay::stats
