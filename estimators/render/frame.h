#pragma once

// An orthonormal frame about a normal.

#include "render/vector.h"

namespace assay::render {

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
