#pragma once

#include <cstdint>
#include <span>

#include "stats/tails/tails.h"

namespace assay::stats {

// The law of D = sup |F_n - F| for n independent values of a continuous law F. Relative errors are
// 1e-10 by the matrix and 2e-9 in the upper tail. The expansion's absolute error is 4e-9. Small D
// use Durbin's matrix in the form of Marsaglia, Tsang & Wang (JSS 8(18), 2003) where it is
// affordable. The rest of the body uses the expansion of Pelz & Good (JRSS B 38, 1976). The upper
// tail is twice Smirnov's one-sided tail with its leading correction. The division of the range
// follows Simard & L'Ecuyer (JSS 39(11), 2011). Throws std::domain_error for n = 0 and for
// distances outside [0, 1].
LogTails kolmogorov_tails(double distance, std::uint64_t n);

// ln P(sup (F_n - F) >= distance), Smirnov's one-sided law (Birnbaum & Tingey 1951, equation 3.0).
// Throws as kolmogorov_tails.
double log_smirnov_one_sided(double distance, std::uint64_t n);

// ln P(K >= z) of the limit law of sqrt(n) D: K(z) = 2 sum (-1)^(k-1) exp(-2 k^2 z^2).
// Throws std::domain_error for z below 0.
double log_kolmogorov_limit(double z);

// The distance d with P(D >= d) = exp(log_probability). Throws std::domain_error for n = 0 and for
// a logarithm that is not below 0.
double kolmogorov_upper_quantile(double log_probability, std::uint64_t n);

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
