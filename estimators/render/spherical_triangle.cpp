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
      cos_ab_(dot(a_, b_)) {
  const double alpha = angle_between(perpendicular_part(a_, b_), towards_c_);
  cos_alpha_ = std::cos(alpha);
  sin_alpha_ = std::sin(alpha);
}

Vector3 SphericalTriangle::edge_point(double u) const {
  // With the angle at b of the part triangle phi - alpha: s = sin(phi), t = cos(phi), where the
  // angles of the part sum to pi + u solid_angle (Arvo 1995, equations 2 to 4).
  const double excess = u * solid_angle_;
  const double sine = -std::sin(excess);
  const double cosine = -std::cos(excess);
  const double s = sine * cos_alpha_ - cosine * sin_alpha_;
  const double t = cosine * cos_alpha_ + sine * sin_alpha_;
  const double k1 = t + cos_alpha_;
  const double k2 = s - sin_alpha_ * cos_ab_;
  const double q = (k2 + (k2 * t - k1 * s) * cos_alpha_) / ((k2 * s + k1 * t) * sin_alpha_);
  const double cos_b = std::clamp(q, -1.0, 1.0);
  return cos_b * a_ + std::sqrt(1 - cos_b * cos_b) * towards_c_;
}

Vector3 SphericalTriangle::arc_point(const Vector3& c_prime, double v) const {
  const double z = 1 - v * (1 - dot(c_prime, b_));
  return z * b_ + std::sqrt(std::max(0.0, 1 - z * z)) * perpendicular_part(b_, c_prime);
}

std::array<double, 2> SphericalTriangle::coordinates(const Vector3& w) const {
  Vector3 c_prime = normalised(cross(cross(b_, w), cross(c_, a_)));
  if (dot(c_prime, a_ + c_) < 0) c_prime = -c_prime;
  const double u = render::solid_angle(a_, b_, c_prime) / solid_angle_;
  const double v = squared_length(w - b_) / squared_length(c_prime - b_);
  return {std::min(u, 1.0), std::min(v, 1.0)};
}

bool SphericalTriangle::contains(const Vector3& w) const {
  const double side = dot(a_, cross(b_, c_)) > 0 ? 1 : -1;
  const auto inside = [&](const Vector3& from, const Vector3& to) {
    return side * dot(w, cross(from, to)) >= 0;
  };
  return inside(a_, b_) && inside(b_, c_) && inside(c_, a_);
}

}  // namespace assay::render
