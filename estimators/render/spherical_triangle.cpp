#include "render/spherical_triangle.h"

#include <algorithm>

#include "render/polygon.h"

namespace assay::render {

namespace {

// The unit vector in the plane of `axis` and v, at right angles to `axis`, on v's side.
Vector3 perpendicular_part(const Vector3& axis, const Vector3& v) {
  return normalised(v - dot(v, axis) * axis);
}

}  // namespace

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
