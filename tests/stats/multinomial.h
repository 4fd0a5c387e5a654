#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/philox.h"

namespace assay::tests {

/// Counts of n values in cells of these probabilities, cell by cell from the binomial law that the
/// cells before leave.
inline std::vector<std::uint64_t> multinomial(Philox& random, std::uint64_t n,
                                              const std::vector<double>& law) {
  std::vector<std::uint64_t> counts(law.size());
  double left = 1;
  for (std::size_t i = 0; i < law.size() && n > 0; ++i) {
    const double share = std::clamp(law[i] / left, 0.0, 1.0);
    counts[i] =
        i + 1 == law.size() ? n : std::binomial_distribution<std::uint64_t>(n, share)(random);
    n -= counts[i];
    left -= law[i];
  }
  return counts;
}

}  // namespace assay::tests
