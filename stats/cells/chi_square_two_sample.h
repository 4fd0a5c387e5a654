#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stats/cells/chi_square_effect.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Counts of two independent samples in the same cells. The cells are fixed beforehand, or chosen
// from the values of both together.
struct TwoSampleCounts {
  std::vector<std::uint64_t> x;
  std::vector<std::uint64_t> y;
};

struct PooledPair {
  std::uint64_t x = 0;
  std::uint64_t y = 0;
  double part = 0;                   // Contribution to X2.
  std::vector<std::size_t> members;  // Indices of the caller's cells.
};

struct ChiSquareTwoSample {
  TestResult test;  // log_p_upper is the p-value of "one law over the cells".
  ChiSquareStatistic statistic;
  std::vector<PooledPair> cells;
};

// Null hypothesis: both samples have the same probabilities over the cells.
//   X2 = sum (sqrt(n/m) a - sqrt(m/n) b)^2 / (a + b),  m and n the sizes.
// Chi-square with nu = pools - 1 (Pearson 1911). Cells are pooled in index order until both samples
// are expected to have minimum_expected in each. Pooling looks at the totals a + b alone. Given
// those the null law is hypergeometric, so the choice costs nothing. Cells without a value in
// either sample do not count. The effect is
//   w = sqrt(sum (p - q)^2 / pi),  pi = (m p + n q) / (m + n).
// X2 is near noncentral chi-square of ncp = w^2 m n / (m + n). Asymptotic. Throws
// std::domain_error: lengths differ, an empty sample, fewer than two pools.
ChiSquareTwoSample chi_square_two_sample(const TwoSampleCounts& counts,
                                         double minimum_expected = 20);

}  // namespace assay::stats
