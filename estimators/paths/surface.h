#pragma once

// Surfaces, and points of them that a path has reached. A grey scene carries the same number in all
// three colours.

#include <cstdint>

#include "render/rgb.h"
#include "render/vector.h"

namespace assay::paths {

using render::Rgb;

/// Emits evenly into the hemisphere; reflects `diffuse` evenly and `mirror` as a mirror does. Both
/// sides are alike.
struct Surface {
  Rgb emission;  ///< radiance
  Rgb diffuse;   ///< diffuse albedo
  Rgb mirror;    ///< reflectance as a mirror

  constexpr Rgb albedo() const { return diffuse + mirror; }
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
