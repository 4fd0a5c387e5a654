#pragma once

// What a surface does with light, and a point of it that a path has reached.

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

/// Where a path has arrived.
struct Vertex {
  render::Vector3 position;
  render::Vector3 normal;            ///< unit, on the side that was reached
  render::Vector3 arriving;          ///< unit, the way the ray went
  const Surface* surface = nullptr;  ///< none: the ray has left the scene
  std::uint32_t patch = 0;           ///< zone of a sphere, triangle of a mesh
};

/// How a path learns of emitted light.
enum class Direct {
  hit,      ///< by arriving at what emits
  exact,    ///< reflected direct light in closed form at every vertex
  sampled,  ///< one shadow ray at every vertex, to a point of what emits
};

}  // namespace assay::paths
