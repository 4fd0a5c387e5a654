#include "render/polygon.h"

namespace assay::render {

namespace {

const Vector3& next(const Polygon& polygon, std::size_t i) {
  return polygon[i + 1 == polygon.size() ? 0 : i + 1];
}

}  // namespace

Vector3 area_vector(const Polygon& polygon) {
  Vector3 sum;
  // Relative to the first vertex: far from the origin the plain sum would cancel.
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  }
  return 0.5 * sum;
}

Polygon clipped(const Polygon& polygon, const HalfSpace& half_space) {
  Polygon kept;
  bool extent = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3& from = polygon[i];
    const Vector3& to = next(polygon, i);
    const double from_height = half_space.height(from);
    const double to_height = half_space.height(to);
    if (from_height >= 0) kept.push_back(from);
    extent = extent || from_height > 0;
    if (from_height * to_height < 0) {
      kept.push_back(from + (from_height / (from_height - to_height)) * (to - from));
    }
  }
  return extent && kept.size() >= 3 ? kept : Polygon{};
}

double lambert(const Polygon& polygon, const Vector3& n) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3 across = cross(polygon[i], next(polygon, i));
    const double sine = length(across);
    if (sine > 0)
      sum += std::atan2(sine, dot(polygon[i], next(polygon, i))) * dot(n, across) / sine;
  }
  return std::abs(sum) / 2;
}

double solid_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double la = length(a);
  const double lb = length(b);
  const double lc = length(c);
  const double volume = std::abs(dot(a, cross(b, c)));
  const double scale = la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la;
  return 2 * std::atan2(volume, scale);
}

}  // namespace assay::render
