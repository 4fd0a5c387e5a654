#pragma once

// Planar polygons as lists of vertices in order, and what a point sees of them.

#include <array>
#include <span>
#include <vector>

#include "render/vector.h"

namespace assay::render {

using Polygon = std::vector<Vector3>;

/// The points p with dot(normal, p) >= offset.
struct HalfSpace {
  Vector3 normal;
  double offset = 0;

  double height(const Vector3& p) const { return dot(normal, p) - offset; }
};

/// Half the sum of cross products: along the normal by the right-hand rule, as long as the area is
/// large. Exact for planar polygons, the area vector of any spanning surface otherwise.
Vector3 area_vector(const Polygon& polygon);
inline double area(const Polygon& polygon) { return length(area_vector(polygon)); }

/// The part of a polygon in a half space (Sutherland and Hodgman 1974); empty when nothing of
/// positive extent is left. Of a concave polygon the parts stay joined by edges of no area, which
/// changes neither area_vector() nor lambert().
Polygon clipped(const Polygon& polygon, const HalfSpace& half_space);

/// The irradiance at the origin on a surface of unit normal n from a polygon of unit radiance, both
/// sides emitting (Lambert 1760; Baum, Rushmeier and Winget 1989, equation 12). The polygon lies
/// above the horizon, dot(n, p) >= 0: clip it beforehand.
///   E = | sum over edges of angle(v_i, v_i+1) dot(n, normalised(v_i x v_i+1)) | / 2.
/// In [0, pi]. Edges through the origin subtend nothing and add nothing.
double lambert(std::span<const Vector3> polygon, const Vector3& n);

/// The integral of dot(n, w)^2 over the directions w in which a convex polygon is seen from the
/// origin. It is the axial moment of order 2 of Arvo 1995, "Applications of irradiance tensors".
/// The origin must not lie in the polygon's plane.
///   (Omega + sum over edges of dot(n, m_i) integral dot(n, w(s)) ds) / 3.
/// Omega is the solid angle, m_i an edge's unit normal towards the inside, s the arc length along
/// it. It is Stokes' theorem for the field dot(n, w) (n - dot(n, w) w), of divergence 1 - 3 dot(n,
/// w)^2.
double squared_cosine(const Polygon& polygon, const Vector3& n);

/// The solid angle of a triangle from the origin in [0, 2 pi), whichever way round (van Oosterom
/// and Strackee 1983, equation 8).
double solid_angle(const Vector3& a, const Vector3& b, const Vector3& c);

/// True if every vertex lies near the plane through the first vertex along area_vector(). Near is
/// within `tolerance` times the largest distance between vertices.
bool is_planar(const Polygon& polygon, double tolerance);

/// True if a planar polygon turns one way only and once around. Vertices on a straight edge are
/// allowed.
bool is_convex(const Polygon& polygon);

/// The greatest distance between two vertices.
double diameter(const Polygon& polygon);

/// The distance from the origin to the nearest point of a triangle.
double distance_to_triangle(const Vector3& a, const Vector3& b, const Vector3& c);

/// A triangle on the unit sphere, smaller than a hemisphere, with the constants of Arvo (1995),
/// "Stratified sampling of spherical triangles".
///
/// A point uniform in its solid angle is found in two steps. Point c' on the arc from a to c cuts
/// off the fraction u of the solid angle beside edge ab. On the arc from b to c' the cosine is
/// uniform.
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
