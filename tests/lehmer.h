#pragma once

#include "tests/prelude.h"

namespace assay::tests {

/// The samples of tests/tables/make_unequal.R: sums of twelve uniforms of Lehmer's generator, less
/// 6; exact in doubles, and so the same in every language.
inline std::vector<double> lehmer_sums(double seed, std::size_t count) {
  constexpr double modulus = 2147483647;
  std::vector<double> values;
  while (values.size() < count) {
    double sum = 0;
    for (int j = 0; j < 12; ++j) {
      seed = std::fmod(16807 * seed, modulus);
      sum += seed / modulus;
    }
    values.push_back(sum - 6);
  }
  return values;
}

}  // namespace assay::tests
