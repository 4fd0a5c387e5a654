#include "paths/sphere_world.h"

namespace assay::paths {

Zones::Zones(const SphereScene& scene, const Camera& camera)
    : camera_(camera), seen_(render::SphereScene().exit(camera.position, camera.direction, false)) {
  double below = -1;
  for (const SphereScene::Zone& zone : scene.zones) {
    tops_.push_back(zone.top);
    // By Archimedes the area between two heights is in proportion to their difference.
    law_.zones.push_back({(zone.top - below) / 2, zone.surface});
    below = zone.top;
  }
  // Rounding may place a point at the pole a hair above 1.
  tops_.back() = 2;
  law_.seen = at(seen_.z);
}

}  // namespace assay::paths
