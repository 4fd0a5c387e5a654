#pragma once

// Rays against triangles and discs: Embree behind one class.

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "render/triangle_mesh.h"

struct RTCSceneTy;

namespace assay::render {

/// A round occluder, seen from both sides.
struct Disc {
  Vector3 centre;
  Vector3 normal;  ///< unit
  double radius = 0;
};

/// A shape of a scene. Both sides are hit.
using Shape = std::variant<TriangleMesh, Disc>;

/// The points origin + t direction with near <= t <= far, whatever the direction's length.
struct Ray {
  Vector3 origin;
  Vector3 direction;
  double near = 0;
  double far = std::numeric_limits<double>::infinity();
};

/// What a ray hit first.
struct Hit {
  std::uint32_t shape = none;      ///< index into the list the scene was made from, or none
  std::uint32_t primitive = none;  ///< triangle of the mesh
  double t = std::numeric_limits<double>::infinity();

  static constexpr std::uint32_t none = ~std::uint32_t{0};
};

/// An immutable scene, shared by any number of threads. Rays and vertices are rounded to single
/// precision (a relative error of 2^-24 for each coordinate), so put the origin of coordinates
/// where the rays start: a ray from the zero vector starts exactly, and the error of what it sees
/// is an angle of about 1e-7, however far away the scene was built. Intersections are watertight
/// along the edges that triangles of one mesh share (Embree's robust mode).
class Scene {
 public:
  /// std::runtime_error with Embree's message when Embree refuses.
  explicit Scene(const std::vector<Shape>& shapes);

  Hit closest_hit(const Ray& ray) const;
  /// Whether anything lies on the ray.
  bool occluded(const Ray& ray) const;

 private:
  std::shared_ptr<RTCSceneTy> scene_;
};

/// The instruction set that all scenes use, "avx2" or on older processors "sse4.2": hit decisions
/// at edges may differ in the last bit between the two, so a record of a run names it.
std::string isa();

}  // namespace assay::render
