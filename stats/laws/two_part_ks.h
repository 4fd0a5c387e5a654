#pragma once

#include <cstdint>
#include <span>

#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Laws with one atom: black pixels, clamped values. Kolmogorov and Smirnov's distance is
// conservative with ties, so the claim is split: is the atom as probable as it should be, and do
// the other values follow their law? Given the number of values at the atom the others are
// independent and continuous, so each part is exact, and the smaller p-value counts twice
// (Bonferroni).
struct TwoPartTest {
  TestResult atom;   // binomial, or hypergeometric for two samples; both sides
  TestResult rest;   // of the values away from the atom; p = 1 when a sample has none
  double log_p = 0;  // min(0, ln 2 + the smaller of the atom's two-sided and the rest's ln p)
  std::uint64_t atoms_x = 0;
  std::uint64_t atoms_y = 0;  // two samples
};

// Null hypothesis: X equals `value` with this probability and otherwise follows `rest`, the law
// given X != value. Throws std::domain_error: probability outside [0, 1], empty or unsorted values.
struct AtomLaw {
  double value = 0;
  double probability = 0;
  ContinuousLaw rest;
};
TwoPartTest two_part_ks(std::span<const double> sorted, const AtomLaw& law);

// Null hypothesis: two independent samples of one law, which may have an atom at `atom`. The atom's
// part is Fisher's exact test (1935) of two proportions, given the atoms in both samples together;
// its larger one-sided p-value, above 1/2, is given as 1.
TwoPartTest two_part_ks(std::span<const double> sorted_x, std::span<const double> sorted_y,
                        double atom);

}  // namespace assay::stats
