#pragma once

// The emission and reflection of a surface, and a point of it that a path has reached.

#include <cstdint>

#include "paths/spectrum.h"
#include "render/vector.h"

namespace assay::paths {

/// Emits evenly into the hemisphere; reflects `diffuse` evenly and `mirror` as a mirror does. Both
/// sides are alike.
struct Surface {
  Spectrum emission;  ///< radiance
  Spectrum diffuse;   ///< diffuse albedo
  Spectrum mirror;    ///< reflectance as a mirror

  constexpr Spectrum albedo() const { return diffuse + mirror; }
};

/// A point where a path has arrived.
struct Vertex {
  render::Vector3 position;
  render::Vector3 normal;            ///< Unit, on the side that was reached.
  render::Vector3 arriving;          ///< Unit, the way the ray went.
  const Surface* surface = nullptr;  ///< None: the ray has left the scene.
  std::uint32_t patch = 0;           ///< Zone of a sphere, triangle of a mesh.
};

/// How a path learns of emitted light.
enum class Direct {
  hit,      ///< The path arrives at an emitter.
  exact,    ///< Reflected direct light in closed form at every vertex.
  sampled,  ///< One shadow ray at every vertex, to a point of an emitter.
};

}  // namespace assay::paths
