#pragma once

// Points, directions and normals of three-space in double precision.

#include <array>
#include <cmath>

namespace assay::render {

struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;

  constexpr Vector3 operator-() const { return {-x, -y, -z}; }
  constexpr Vector3& operator+=(const Vector3& v) { return *this = {x + v.x, y + v.y, z + v.z}; }
  constexpr bool operator==(const Vector3&) const = default;
};

constexpr Vector3 operator+(const Vector3& a, const Vector3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vector3 operator*(double s, const Vector3& v) { return {s * v.x, s * v.y, s * v.z}; }
constexpr Vector3 operator*(const Vector3& v, double s) { return s * v; }
constexpr Vector3 operator/(const Vector3& v, double s) { return {v.x / s, v.y / s, v.z / s}; }

constexpr double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double squared_length(const Vector3& v) { return dot(v, v); }
inline double length(const Vector3& v) { return std::sqrt(squared_length(v)); }
/// The unit vector along v; not a number for the zero vector, which callers exclude beforehand.
inline Vector3 normalised(const Vector3& v) { return v / length(v); }
/// The angle between two vectors in [0, pi], accurate near both ends, where acos is not.
inline double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

/// A vector as the coordinates of a sampler's point, and back.
constexpr std::array<double, 3> point_of(const Vector3& v) { return {v.x, v.y, v.z}; }
constexpr Vector3 vector_of(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

/// Right-handed: tangent x bitangent = normal.
struct Frame {
  Vector3 tangent;
  Vector3 bitangent;
  Vector3 normal;

  /// A frame about the unit vector n, by Duff et al. (2017), "Building an orthonormal basis,
  /// revisited": continuous but for n.z changing sign; the identity for n = +z.
  static Frame about(const Vector3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }

  Vector3 to_world(const Vector3& v) const {
    return v.x * tangent + v.y * bitangent + v.z * normal;
  }
  Vector3 to_local(const Vector3& v) const {
    return {dot(v, tangent), dot(v, bitangent), dot(v, normal)};
  }
};

}  // namespace assay::render
