#pragma once

// Directions about +z from two uniform numbers.

#include <cmath>

#include "render/unit_circle.h"
#include "render/vector.h"

namespace assay::render {

/// The unit vector of height z in [0, 1] and azimuth 2 pi v.
inline Vector3 direction_at(double z, double v) {
  const double radius = std::sqrt(1 - z * z);
  const auto [x, y] = on_unit_circle(v);
  return {radius * x, radius * y, z};
}

/// Density 1 / (2 pi) per solid angle: by Archimedes the height is uniform.
inline Vector3 uniform_hemisphere(double u, double v) { return direction_at(u, v); }

/// Density z / pi per solid angle: the projection on the plane z = 0 is uniform in the unit disc.
inline Vector3 cosine_hemisphere(double u, double v) {
  const double radius = std::sqrt(u);
  const auto [x, y] = on_unit_circle(v);
  return {radius * x, radius * y, std::sqrt(1 - u)};
}

}  // namespace assay::render
