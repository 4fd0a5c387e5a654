#pragma once

// A scene that paths walk in, as a suite states it.

#include <string>
#include <variant>
#include <vector>

#include "estimators/value.h"
#include "paths/surface.h"
#include "render/triangle_mesh.h"

namespace assay::paths {

/// A ray whose radiance is estimated.
struct Camera {
  render::Vector3 position;
  render::Vector3 direction;  ///< unit
};

/// The unit sphere about the origin from inside, in zones from z = -1 upwards.
struct SphereScene {
  struct Zone {
    double top;  ///< largest z; of the last zone 1
    Surface surface;
  };
  std::vector<Zone> zones;
};

/// Triangles, each of a surface.
struct MeshScene {
  render::TriangleMesh mesh;
  std::vector<std::uint32_t> surface_of;  ///< of each triangle
  std::vector<Surface> surfaces;
  bool furnace = false;  ///< closed, of one surface, the camera inside
};

struct SceneDescription {
  std::variant<SphereScene, MeshScene> form;
  Camera camera;
  /// Whether every number was given once for all colours: there is one channel then.
  bool grey = true;
};

/// Reads a scene: a built-in name or a map as in estimators/README.md. Files are relative to
/// `folder`. InputError at the offending node: what luminaire's scenes refuse; an emission that is
/// negative; an albedo that is negative or, together with `mirror`, 1 or more in a channel; zones
/// whose tops do not ascend from -1 to 1; a camera that is not inside the sphere or the furnace; a
/// furnace whose mesh is open or not oriented consistently.
SceneDescription read_scene(const Value& value, const std::string& folder);

std::vector<std::string> built_in_scenes();

}  // namespace assay::paths
