#pragma once

// Directions uniform in the solid angle of a triangle.

#include <array>

#include "render/vector.h"

namespace assay::render {

/// A triangle on the unit sphere, smaller than a hemisphere, with the constants of Arvo (1995),
/// "Stratified sampling of spherical triangles".
///
/// A point is found in two steps. Point c' on the arc from a to c cuts off the fraction u of the
/// solid angle beside edge ab. On the arc from b to c' the cosine is uniform.
///
/// The first step solves the excess E of a triangle for tan(ac' / 2). The triangle has two sides
/// and the angle between them (Todhunter 1886, Spherical Trigonometry, article 103).
///  `tan(E / 2) = tan(ab / 2) tan(ac' / 2) sin(alpha) / (1 + tan(ab / 2) tan(ac' / 2) cos(alpha))`.
/// It is Arvo's map. His equation for cos(ac') has differences that lose half the digits in thin
/// triangles.
class SphericalTriangle {
 public:
  /// Vertices seen from the origin, of any length, either way round; not in one plane with it.
  SphericalTriangle(const Vector3& a, const Vector3& b, const Vector3& c);

  double solid_angle() const { return solid_angle_; }

  /// c' such that the triangle a, b, c' has u times the solid angle; u in [0, 1].
  Vector3 edge_point(double u) const;
  /// The unit vector on the arc from b to c' whose cosine with b is 1 - v (1 - cos(b, c')).
  Vector3 arc_point(const Vector3& c_prime, double v) const;
  /// Uniform in solid angle for uniform u, v.
  Vector3 sample(double u, double v) const { return arc_point(edge_point(u), v); }

  /// The (u, v) that sample() maps to the unit vector w of the triangle. It is uniform on the unit
  /// square if w is uniform in the triangle.
  std::array<double, 2> coordinates(const Vector3& w) const;
  bool contains(const Vector3& w) const;

  const Vector3& a() const { return a_; }
  const Vector3& b() const { return b_; }
  const Vector3& c() const { return c_; }

 private:
  Vector3 a_;
  Vector3 b_;
  Vector3 c_;
  Vector3 towards_c_;  // the unit tangent at a of the arc from a to c
  double solid_angle_;
  double cot_half_ab_;
  double cos_alpha_;
  double sin_alpha_;
  std::array<Vector3, 3> inward_;  // normals of the sides' planes
};

}  // namespace assay::render
