#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "stats/basics/moments.h"
#include "tests/philox.h"

namespace assay::tests {

inline stats::Moments moments_of(std::span<const double> values) {
  stats::Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

template <class Draw>
std::vector<double> sample_of(std::size_t n, Draw&& draw) {
  std::vector<double> values(n);
  for (double& value : values) value = draw();
  return values;
}

template <class Draw>
stats::Moments draw_moments(std::size_t n, Draw&& draw) {
  stats::Moments moments;
  for (std::size_t i = 0; i < n; ++i) moments.add(draw());
  return moments;
}

/// A stationary AR(1) chain of unit variance; of its n values (1 - phi) / (1 + phi) are effective.
inline std::vector<double> autoregressive(double phi, std::size_t n, Philox& random) {
  std::vector<double> values;
  double x = random.normal();
  for (std::size_t t = 0; t < n; ++t) {
    values.push_back(x);
    x = phi * x + std::sqrt(1 - phi * phi) * random.normal();
  }
  return values;
}

inline std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

// The worked example that golden values of several methods refer to.
inline const std::vector<double> golden_x{.12, .95, .33, 1.71, .58, 2.40, .05, .77, 1.13, .29};
inline const std::vector<double> golden_y{.40, 1.22, .91, 3.10, .66, 1.85, .51};

}  // namespace assay::tests
