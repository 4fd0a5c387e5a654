#pragma once

// A luminaire scene as its receiver sees it: the parts that do not depend on the sample, shared by
// all workers.
//
// All of it is in the receiver's frame. The receiver is the origin and its normal is +z. So the
// receiver's cosine of a unit vector w is w.z, and every ray starts at the exact zero vector.
//
// The family estimates the irradiance at a receiver from a diffuse luminaire,
//   E = integral over directions w of L(w) max(0, n . w).
// L(w) is the radiance of the luminaire if a ray along w hits it first, else 0. Parts of the
// luminaire below the receiver's horizon, and sides that do not emit, contribute nothing.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "luminaire/scene_description.h"
#include "render/scene.h"
#include "render/vector.h"

namespace assay::luminaire {

/// Surfaces are told apart down to this fraction of a distance.
///
/// Rays ignore surfaces nearer to the receiver. A shadow ray ignores this fraction of the way to
/// the point on the luminaire. A closest-hit ray ignores it of the way to the luminaire's nearest
/// point. The luminaire stops rays as if it were nearer by this fraction, and shadow rays end twice
/// as much before it. So a lamp wins over the wall that it is let into, for every estimator.
inline constexpr double resolution = 0x1p-14;

struct LightTriangle {
  render::Vector3 a;       ///< first vertex
  render::Vector3 ab;      ///< edge to the second
  render::Vector3 ac;      ///< edge to the third
  render::Vector3 normal;  ///< unit, on the side that emits
  double area = 0;
  double plane_distance = 0;  ///< of the receiver above the side that emits, negative behind
  bool emits = false;         ///< whether the side that emits faces the receiver
};

/// The line from the receiver to a point of the luminaire.
struct Connection {
  render::Vector3 to_light;  ///< from the receiver to the point
  double squared_distance = 0;
  double light_height =
      0;  ///< of the receiver above the luminaire's emitting side, negative behind

  double receiver_height() const { return to_light.z; }
  double distance() const { return std::sqrt(squared_distance); }
  double receiver_cosine() const { return receiver_height() / distance(); }
  double light_cosine() const { return light_height / distance(); }
};

/// A way from the receiver to a point of the luminaire and what it brings if nothing stands in it.
struct LightSample {
  render::RoundedRay ray;
  double value = 0;
};

/// The shadow ray from the receiver to a point of the luminaire.
inline render::RoundedRay shadow_ray(const render::Vector3& to_light) {
  return render::RoundedRay({.direction = to_light, .near = resolution, .far = 1 - 2 * resolution});
}

class Setting {
 public:
  /// InputError at `where` when the receiver lies on the luminaire.
  Setting(const SceneDescription& description, const Location& where);

  double radiance() const { return radiance_; }
  const std::vector<LightTriangle>& triangles() const { return triangles_; }
  /// Area of all triangles, those that face away included.
  double area() const { return area_; }
  /// True if the luminaire is one planar polygon; it then does not shade itself.
  bool planar() const { return planar_; }
  /// The planar polygon as written, in the receiver's frame; empty for a mesh.
  const render::Polygon& polygon() const { return polygon_; }
  /// The occluders' polygons in the receiver's frame; none when some occluder is something else.
  const std::optional<std::vector<render::Polygon>>& polygonal_occluders() const {
    return polygonal_occluders_;
  }
  /// Below this distance rays see nothing.
  double near() const { return near_; }

  /// The way from the receiver to the point a + u ab + v ac of a triangle.
  Connection connect(const LightTriangle& triangle, double u, double v) const {
    const render::Vector3 y = triangle.a + u * triangle.ab + v * triangle.ac;
    return {y, squared_length(y), triangle.plane_distance};
  }

  /// The ray from the receiver along a unit vector.
  render::RoundedRay ray(const render::Vector3& direction) const {
    return render::RoundedRay({.direction = direction, .near = near_});
  }

  /// The triangle of the luminaire that a ray from the receiver hits first, from either side; none
  /// where it hits something else or nothing.
  const LightTriangle* first_hit(const render::RoundedRay& ray, Cost& cost) const {
    ++cost.closest_hit_rays;
    const render::Hit hit = scene_.closest_hit(ray);
    return hit.shape == 0 ? &triangles_[hit.primitive] : nullptr;
  }

  /// True if a ray from the receiver first hits a side of the luminaire that emits.
  bool sees_light(const render::RoundedRay& ray, Cost& cost) const {
    const LightTriangle* const triangle = first_hit(ray, cost);
    return triangle && triangle->emits;
  }

  /// The value of a light sample, or 0 if a shadow ray is blocked. No ray is traced for a value of
  /// 0.
  double received(const LightSample& sample, Cost& cost) const {
    if (sample.value == 0) return 0;
    ++cost.shadow_rays;
    return blockers_.occluded(sample.ray) ? 0 : sample.value;
  }

 private:
  double radiance_;
  bool planar_;
  render::Polygon polygon_;
  std::vector<LightTriangle> triangles_;
  std::optional<std::vector<render::Polygon>> polygonal_occluders_;
  double area_;
  double near_;
  render::Scene scene_;     // the luminaire and the occluders
  render::Scene blockers_;  // what can stand before the luminaire
};

using SharedSetting = std::shared_ptr<const Setting>;

/// The parameter `scene`, common to the family, and static information with it.
ParameterInformation scene_parameter();
Information information(std::string name, std::string summary, std::string description);

SharedSetting read_setting(Parameters& parameters);

/// Occluders in the receiver's frame, as shapes of a scene.
std::vector<render::Shape> occluder_shapes(const std::vector<Occluder>& occluders,
                                           const Receiver& receiver);

}  // namespace assay::luminaire
