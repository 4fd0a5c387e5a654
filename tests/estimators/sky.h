#pragma once

// The picture that suites and tests share as suites/data/sky.exr: a gradient and a sun.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace assay::draws {

inline constexpr std::size_t sky_width = 64;
inline constexpr std::size_t sky_height = 32;

/// Red, green and blue of texel (row, column): L = 1 + bx wx + bz wz at its middle. The slopes (bx,
/// bz) are (0.3, 0.2), (0.1, 0.4) and (-0.2, 0.7). Eight texels have a sun of radiance 60, 50, 40
/// on top.
inline std::vector<float> sky_texel(std::size_t row, std::size_t column) {
  const double theta = std::numbers::pi * (static_cast<double>(row) + 0.5) / sky_height;
  const double phi = 2 * std::numbers::pi * (static_cast<double>(column) + 0.5) / sky_width;
  const double x = std::sin(theta) * std::cos(phi);
  const double z = std::cos(theta);
  const bool sun = (row == 6 || row == 7) && column >= 5 && column < 9;
  return {static_cast<float>(1 + 0.3 * x + 0.2 * z + (sun ? 60 : 0)),
          static_cast<float>(1 + 0.1 * x + 0.4 * z + (sun ? 50 : 0)),
          static_cast<float>(1 - 0.2 * x + 0.7 * z + (sun ? 40 : 0))};
}

}  // namespace assay::draws
