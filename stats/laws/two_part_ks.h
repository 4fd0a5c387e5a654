#pragma once

#include <cstdint>
#include <span>

#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Test of laws with one atom: black pixels, clamped values. Kolmogorov and Smirnov's distance is
// conservative with ties, so the claim is split in two: the atom's probability, and the law of the
// other values. Given the number at the atom the others are independent and continuous. So each
// part is exact, and the smaller p-value counts twice (Bonferroni).
struct TwoPartTest {
  TestResult atom;  // Hypergeometric, both sides.
  TestResult rest;  // Values away from the atom; p = 1 when a sample has none.
  // min(0, ln 2 + the smaller of the two parts' ln p). The atom's is two-sided.
  double log_p = 0;
  std::uint64_t atoms_x = 0;
  std::uint64_t atoms_y = 0;
};

// Null hypothesis: two independent samples of one law, which may have an atom at `atom`. The atom's
// part is Fisher's exact test (1935) of two proportions, given the atoms in both together. Its
// larger one-sided p-value, above 1/2, is given as 1. Throws std::domain_error: empty or unsorted
// values, an atom that is not finite.
TwoPartTest two_part_ks(std::span<const double> sorted_x, std::span<const double> sorted_y,
                        double atom);

}  // namespace assay::stats
