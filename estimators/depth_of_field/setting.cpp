#include "depth_of_field/setting.h"

#include <utility>

namespace assay::depth_of_field {

namespace {

std::vector<render::Shape> shapes(const SceneDescription& scene) {
  std::vector<render::Shape> out;
  for (const Plane& p : scene.planes) {
    out.emplace_back(render::fan({{p.x.low, p.y.low, p.depth},
                                  {p.x.high, p.y.low, p.depth},
                                  {p.x.high, p.y.high, p.depth},
                                  {p.x.low, p.y.high, p.depth}}));
  }
  return out;
}

}  // namespace

Setting::Setting(SceneDescription scene) : scene_(std::move(scene)), rays_(shapes(scene_)) {}

const Plane* Setting::first_hit(const PlanePoint& pixel, const PlanePoint& u, Cost& cost) const {
  ++cost.camera_rays;
  const render::Hit hit = rays_.closest_hit(lens_ray(scene_.lens, pixel, u));
  return hit.shape == render::Hit::none ? nullptr : &scene_.planes[hit.shape];
}

}  // namespace assay::depth_of_field
