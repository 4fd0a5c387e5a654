#pragma once

// A point that receives light, a luminaire and what stands between, as a suite states them.

#include <string>
#include <variant>
#include <vector>

#include "estimators/core/value.h"
#include "render/scene.h"

namespace assay::luminaire {

struct Receiver {
  render::Vector3 position;
  render::Vector3 normal;  ///< unit
};

/// A diffuse luminaire of one radiance.
struct Light {
  /// A polygon is planar and convex.
  std::variant<render::Polygon, render::TriangleMesh> shape;
  double radiance = 1;
  /// True if the side emits from which the vertices are seen clockwise.
  bool clockwise = false;
};

/// Blocks light from both sides. A polygon is planar and convex.
using Occluder = std::variant<render::Polygon, render::Disc, render::TriangleMesh>;

struct SceneDescription {
  Receiver receiver;
  Light light;
  std::vector<Occluder> occluders;
};

/// Reads a scene: the name of a built-in one (triangle, cornell_triangle, rectangle), or a map
///  `receiver:  {position: [0, 0, 0], normal: [0, 0, 1]}
///   light:     {polygon: [[.2, -.4, 1], [1.6, .3, 1.4], [-.3, 1.2, 1.1]], radiance: 1}
///   occluders: [{polygon: [...]}, {disc: {center: [0, 0, .4], normal: [0, 0, 1], radius: .1}},
///               {obj: chair.obj}]`.
/// A light has `polygon` or `obj`, and file names are relative to `folder`. A polygon emits from
/// the receiver's side, or from the one that an optional `normal` of the light points from. A mesh
/// emits from the counter-clockwise side of each triangle.
///
/// InputError at the offending node: an unknown name or key, a missing key, a number that is not
/// finite, a zero normal. InputError, too, for a polygon of fewer than three vertices, without
/// area, not planar (to 1e-6 of its diameter) or not convex. InputError for a negative radius or
/// radiance, and for whatever read_obj() refuses.
SceneDescription read_scene(const Value& value, const std::string& folder);

/// The occluders of a scene alone: a list as under its key `occluders`. The same errors.
std::vector<Occluder> read_occluders(const Value& value, const std::string& folder);

/// A list of three finite numbers, and one that is not zero scaled to unit length. `what` names the
/// thing in the message.
render::Vector3 read_vector(const Value& value, const std::string& what);
render::Vector3 read_unit_vector(const Value& value, const std::string& what);

/// A planar convex polygon, and the triangles of an OBJ file that is named relative to `folder`.
/// The same errors as in a scene.
render::Polygon read_polygon(const Value& value, const std::string& what);
render::TriangleMesh read_mesh(const Value& value, const std::string& what,
                               const std::string& folder);

}  // namespace assay::luminaire
