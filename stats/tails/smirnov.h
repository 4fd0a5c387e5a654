#pragma once

#include <cstdint>

#include "stats/tails/test_result.h"

namespace assay::stats {

// A two-sample distance max |F_m - G_n| as a whole number of steps of 1 / lcm(m, n).
struct LatticeDistance {
  std::uint64_t steps = 0;
  std::uint64_t m = 1;
  std::uint64_t n = 1;

  double value() const;
};

struct SmirnovTail {
  double log_p = 0;  // ln P(max |F_m - G_n| >= distance).
  Exactness exactness = Exactness::exact;
};

// The tail for two samples of one continuous law. For m = n of any size it is the reflection
// formula in nested form (Gnedenko & Korolyuk 1951). Otherwise, up to m n = 1e8, a recursion over
// the lattice of paths gives the upper tail itself, free of cancellation. (In the manner of Hodges
// 1957 and Schroeer & Trenkler 1995.) Beyond it is the limit law at sqrt(m n / (m + n)) d,
// asymptotic. Throws std::domain_error for empty samples, and when lcm(m, n) is beyond 2^62.
SmirnovTail smirnov_upper_tail(LatticeDistance distance);

}  // namespace assay::stats
