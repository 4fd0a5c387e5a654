#pragma once

// Rays against triangles and discs: Embree behind one class.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "render/triangle_mesh.h"
#include "render/vector.h"

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

/// A ray in single precision, as Embree takes it. Make many rays before you trace the first: what
/// was written float by float is slow to read back as a whole at once.
class RoundedRay {
 public:
  RoundedRay() = default;
  explicit RoundedRay(const Ray& ray)
      : numbers_{single(ray.origin.x),    single(ray.origin.y),
                 single(ray.origin.z),    single(ray.near),
                 single(ray.direction.x), single(ray.direction.y),
                 single(ray.direction.z), 0,
                 single(ray.far)} {}

 private:
  friend class Scene;

  static float single(double x) { return static_cast<float>(x); }

  // In the order of Embree's RTCRay: origin, near, direction, time, far.
  alignas(16) std::array<float, 9> numbers_{};
  std::uint32_t mask_ = ~0u;
  std::uint32_t id_ = 0;
  std::uint32_t flags_ = 0;
};

/// The first hit of a ray.
struct Hit {
  std::uint32_t shape = none;      ///< index into the list the scene was made from, or none
  std::uint32_t primitive = none;  ///< triangle of the mesh
  double t = std::numeric_limits<double>::infinity();

  static constexpr std::uint32_t none = ~std::uint32_t{0};
};

/// An immutable scene, shared by any number of threads. Rays and vertices are rounded to single
/// precision, a relative error of 2^-24 for each coordinate. So put the origin of coordinates where
/// the rays start: a ray from the zero vector starts exactly. The error of its view is then an
/// angle of about 1e-7, at any distance. Edges that triangles of one mesh share are watertight
/// (Embree's robust mode).
class Scene {
 public:
  /// std::runtime_error with Embree's message when Embree refuses.
  explicit Scene(const std::vector<Shape>& shapes);

  Hit closest_hit(const RoundedRay& ray) const;
  Hit closest_hit(const Ray& ray) const { return closest_hit(RoundedRay(ray)); }
  /// True if anything lies on the ray.
  bool occluded(const RoundedRay& ray) const;
  bool occluded(const Ray& ray) const { return occluded(RoundedRay(ray)); }

 private:
  std::shared_ptr<RTCSceneTy> scene_;
};

}  // namespace assay::render
