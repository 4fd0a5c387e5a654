#pragma once

// A scene that paths walk in, as a suite states it.

#include <string>
#include <variant>
#include <vector>

#include "estimators/core/value.h"
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
  /// True if every number was given once for all colours: there is one channel then.
  bool grey = true;
};

/// Reads a scene: a built-in name (furnace, sphere, coloured_sphere, box), or a map of `camera` and
/// one of `zones`, `furnace` and `surfaces`.
///  `camera:   {position: [0, 0, 0], direction: [0, 0, -1]}
///   zones:    [{top: 0.8, emission: 0, albedo: 0.8}, {top: 1, emission: 1, albedo: [.8, .5, .2]}]
///   furnace:  {obj: room.obj, emission: 1, albedo: 0.5, mirror: 0}
///   surfaces: [{polygon: [...], emission: 0, albedo: 0.5, mirror: 0},
///              {obj: lamp.obj, emission: 9, albedo: 0}]`.
/// Zones cut the unit sphere at heights z. A furnace is a closed mesh with the camera inside. Rays
/// that leave surfaces bring nothing. A number may be a list of three colours. Surfaces emit and
/// reflect alike on both sides. Files are relative to `folder`.
///
/// InputError at the offending node: an emission that is negative, an albedo that is negative or,
/// together with `mirror`, 1 or more in a channel. InputError, too, for zones whose tops do not
/// ascend from -1 to 1, and a camera that is not inside the sphere or the furnace. InputError for a
/// furnace whose mesh is open or not oriented consistently, and for whatever luminaire's scenes
/// refuse.
SceneDescription read_scene(const Value& value, const std::string& folder);

/// Empty if every edge of a triangle is an edge of exactly one other, run through the opposite way.
/// Else a sentence that names an edge which is not (vertices counted from 1).
std::string why_not_closed(const render::TriangleMesh& mesh);

/// How often a closed mesh winds about a point: +-1 inside, 0 outside. The sum of the triangles'
/// signed solid angles (van Oosterom & Strackee 1983, eq. 8) over 4 pi, rounded.
int winding_number(const render::TriangleMesh& mesh, const render::Vector3& point);

}  // namespace assay::paths
