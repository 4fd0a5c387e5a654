#pragma once

// A scene ready for rays: its rectangles as triangles in Embree.

#include <memory>

#include "depth_of_field/scene_description.h"
#include "estimators/cost.h"

namespace assay::depth_of_field {

class Setting {
 public:
  explicit Setting(SceneDescription scene);

  const SceneDescription& scene() const { return scene_; }

  /// The first plane on the ray from the lens point (unit disc) through the pixel, or none.
  const Plane* first_hit(const PlanePoint& pixel, const PlanePoint& u, Cost& cost) const;

  /// The radiance that arrives at the lens point from the pixel. What is hit is Embree's to say
  /// (edges are off by about 1e-7 of their coordinates); where, is worked out in double precision.
  double radiance(const PlanePoint& pixel, const PlanePoint& u, Cost& cost) const {
    const Plane* const plane = first_hit(pixel, u, cost);
    if (!plane) return scene_.background;
    return plane->texture.at(footprint(scene_.lens, pixel, plane->depth).at(u).x);
  }

 private:
  SceneDescription scene_;
  render::Scene rays_;
};

using SharedSetting = std::shared_ptr<const Setting>;

}  // namespace assay::depth_of_field
