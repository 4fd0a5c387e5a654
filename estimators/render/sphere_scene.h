#pragma once

// The inside of a sphere in double precision, as a user geometry of Embree.

#include <memory>

#include "render/vector.h"

struct RTCSceneTy;

namespace assay::render {

/// The unit sphere about the origin. Embree finds the rays that reach the sphere's box. The hit is
/// worked out in double precision, so that the sphere is round to 1e-15.
class SphereScene {
 public:
  SphereScene();

  /// The unit vector where a ray from inside the sphere, or from its surface, leaves it. Set
  /// `from_surface` for a ray from the surface, whose starting point is not hit again.
  Vector3 exit(const Vector3& origin, const Vector3& direction, bool from_surface) const;

  /// True if the sphere stands between two points of its surface (it does not: it is convex).
  bool occluded(const Vector3& from, const Vector3& to) const;

 private:
  std::shared_ptr<RTCSceneTy> scene_;
};

}  // namespace assay::render
