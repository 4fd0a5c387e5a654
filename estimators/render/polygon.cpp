#include "render/polygon.h"

#include <algorithm>
#include <numbers>

namespace assay::render {

namespace {

const Vector3& next(std::span<const Vector3> polygon, std::size_t i) {
  return polygon[i + 1 == polygon.size() ? 0 : i + 1];
}

// The integral of dot(n, w) along the great arc from a to b, both of unit length. The arc is w(s) =
// a cos s + (m x a) sin s, with m the unit normal of its plane.
double arc_integral(const Vector3& a, const Vector3& b, const Vector3& m, const Vector3& n) {
  const double sine = dot(m, cross(a, b));
  const double one_minus_cosine = squared_length(a - b) / 2;
  return dot(n, a) * sine + dot(n, cross(m, a)) * one_minus_cosine;
}

double distance_to_segment(const Vector3& a, const Vector3& b) {
  const Vector3 along = b - a;
  const double t = std::clamp(-dot(a, along) / squared_length(along), 0.0, 1.0);
  return length(a + t * along);
}

// The unit vector in the plane of `axis` and v, at right angles to `axis`, on v's side.
Vector3 perpendicular_part(const Vector3& axis, const Vector3& v) {
  return normalised(v - dot(v, axis) * axis);
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

double lambert(std::span<const Vector3> polygon, const Vector3& n) {
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

double squared_cosine(const Polygon& polygon, const Vector3& n) {
  double omega = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    omega += solid_angle(polygon[0], polygon[i], polygon[i + 1]);
  }
  const double inside = dot(area_vector(polygon), polygon[0]) > 0 ? 1 : -1;
  double boundary = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3 across = cross(polygon[i], next(polygon, i));
    if (squared_length(across) == 0) continue;
    const Vector3 m = normalised(across);
    boundary +=
        dot(n, m) * arc_integral(normalised(polygon[i]), normalised(next(polygon, i)), m, n);
  }
  return (omega + inside * boundary) / 3;
}

bool is_planar(const Polygon& polygon, double tolerance) {
  const Vector3 n = normalised(area_vector(polygon));
  const double bound = tolerance * diameter(polygon);
  return std::ranges::all_of(
      polygon, [&](const Vector3& p) { return std::abs(dot(n, p - polygon[0])) <= bound; });
}

bool is_convex(const Polygon& polygon) {
  const Vector3 n = normalised(area_vector(polygon));
  double turned = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    const Vector3 in = polygon[j] - polygon[i];
    const Vector3 out = next(polygon, j) - polygon[j];
    const double turn = std::atan2(dot(n, cross(in, out)), dot(in, out));
    // Rounding of a straight continuation; a real dent turns further.
    if (turn < -1e-9) return false;
    turned += turn;
  }
  return turned < 3 * std::numbers::pi;
}

double diameter(const Polygon& polygon) {
  double largest = 0;
  for (const Vector3& a : polygon) {
    for (const Vector3& b : polygon) largest = std::max(largest, length(a - b));
  }
  return largest;
}

double distance_to_triangle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 n = normalised(cross(b - a, c - a));
  const Vector3 foot = dot(n, a) * n;
  const auto left_of = [&](const Vector3& from, const Vector3& to) {
    return dot(n, cross(to - from, foot - from)) >= 0;
  };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return std::abs(dot(n, a));
  return std::min(
      {distance_to_segment(a, b), distance_to_segment(b, c), distance_to_segment(c, a)});
}

SphericalTriangle::SphericalTriangle(const Vector3& a, const Vector3& b, const Vector3& c)
    : a_(normalised(a)),
      b_(normalised(b)),
      c_(normalised(c)),
      towards_c_(perpendicular_part(a_, c_)),
      solid_angle_(render::solid_angle(a_, b_, c_)),
      cot_half_ab_(1 / std::tan(angle_between(a_, b_) / 2)) {
  const double alpha = angle_between(perpendicular_part(a_, b_), towards_c_);
  cos_alpha_ = std::cos(alpha);
  sin_alpha_ = std::sin(alpha);
  const double sense = dot(a_, cross(b_, c_)) > 0 ? 1 : -1;
  inward_ = {sense * cross(a_, b_), sense * cross(b_, c_), sense * cross(c_, a_)};
}

Vector3 SphericalTriangle::edge_point(double u) const {
  const double half_excess = u * solid_angle_ / 2;
  const double sine = std::sin(half_excess);
  const double cosine = std::cos(half_excess);
  const double tangent = sine * cot_half_ab_ / (sin_alpha_ * cosine - cos_alpha_ * sine);
  const double scale = 1 / (1 + tangent * tangent);
  return ((1 - tangent * tangent) * scale) * a_ + (2 * tangent * scale) * towards_c_;
}

Vector3 SphericalTriangle::arc_point(const Vector3& c_prime, double v) const {
  // 1 - cos, as half a squared chord: near b the cosine itself would keep no digit of it.
  const double fall = v * squared_length(c_prime - b_) / 2;
  return (1 - fall) * b_ + std::sqrt(fall * (2 - fall)) * perpendicular_part(b_, c_prime);
}

std::array<double, 2> SphericalTriangle::coordinates(const Vector3& w) const {
  Vector3 c_prime = normalised(cross(cross(b_, w), cross(c_, a_)));
  if (dot(c_prime, a_ + c_) < 0) c_prime = -c_prime;
  const double u = render::solid_angle(a_, b_, c_prime) / solid_angle_;
  const double v = squared_length(w - b_) / squared_length(c_prime - b_);
  return {std::min(u, 1.0), std::min(v, 1.0)};
}

bool SphericalTriangle::contains(const Vector3& w) const {
  return std::ranges::all_of(inward_, [&](const Vector3& side) { return dot(w, side) >= 0; });
}

}  // namespace assay::render
