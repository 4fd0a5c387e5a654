#pragma once

#include <cstdint>
#include <span>

namespace assay::stats {

// A two-sample distance max |F_m - G_n| as a whole number of steps of 1 / lcm(m, n).
struct LatticeDistance {
  std::uint64_t steps = 0;
  std::uint64_t m = 1;
  std::uint64_t n = 1;

  double value() const;
};

// Equal values of both samples together: those after the first `before` pooled values, `size` of
// them.
struct TiedRun {
  std::uint64_t before = 0;
  std::uint64_t size = 0;
};

// ln P(max |F_m - G_n| >= distance) for two samples of one law, given the ties of both together.
// All orders of the pooled values are equally likely. So the m x n lattice's paths are, and a path
// counts at the ends of runs alone (Schroeer & Trenkler 1995). Without ties it is the tail for
// continuous laws.
//   m = n without ties: the reflection formula in nested form (Gnedenko & Korolyuk 1951).
//   Else: a recursion over the lattice gives the upper tail itself, free of cancellation.
//   If the band of paths has more than 2e8 places, or p is below e^-20000: the tail without ties.
//   It bounds that with ties from above. For m != n it is the limit law at sqrt(m n / (m + n)) d,
//   asymptotic.
// Runs ascend and do not overlap. Throws std::domain_error: empty samples, runs beyond m + n values
// or out of order, lcm(m, n) beyond 2^62.
double smirnov_upper_tail(LatticeDistance distance, std::span<const TiedRun> ties = {});

// Sizes of two samples.
struct TwoSizes {
  std::uint64_t m = 1;
  std::uint64_t n = 1;
};

// Bounds ln P(A + B >= gap) from above, for any F and G. A = sup |F_m - F| and B = sup
// |G_n - G| are independent. The law with tail min(1, 2 exp(-2 n a^2)) dominates each (Massart
// 1990). The convolution of the two dominating laws is bounded from above on a grid.
double log_two_suprema_bound(double gap, TwoSizes sizes);

}  // namespace assay::stats
