#pragma once

// Colours, surfaces, and points of them that a path has reached.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "render/vector.h"

namespace assay::paths {

// Three numbers, one a colour channel. A grey scene carries the same number three times.

struct Spectrum {
  double red = 0;
  double green = 0;
  double blue = 0;

  static constexpr Spectrum grey(double x) { return {x, x, x}; }
  constexpr double operator[](std::size_t c) const { return std::array{red, green, blue}[c]; }
  constexpr bool operator==(const Spectrum&) const = default;
  constexpr Spectrum& operator+=(const Spectrum& s) {
    red += s.red;
    green += s.green;
    blue += s.blue;
    return *this;
  }
};

inline constexpr std::array<const char*, 3> colours = {"red", "green", "blue"};

constexpr Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
constexpr Spectrum operator*(double x, const Spectrum& s) {
  return {x * s.red, x * s.green, x * s.blue};
}
constexpr Spectrum operator-(const Spectrum& a, const Spectrum& b) { return a + -1 * b; }
/// Channel by channel.
constexpr Spectrum operator*(const Spectrum& a, const Spectrum& b) {
  return {a.red * b.red, a.green * b.green, a.blue * b.blue};
}
constexpr Spectrum operator/(const Spectrum& a, const Spectrum& b) {
  return {a.red / b.red, a.green / b.green, a.blue / b.blue};
}
constexpr double sum(const Spectrum& s) { return s.red + s.green + s.blue; }
constexpr double mean(const Spectrum& s) { return sum(s) / 3; }
constexpr double largest(const Spectrum& s) { return std::max({s.red, s.green, s.blue}); }
/// The luminance of linear sRGB primaries (ITU-R BT.709).
constexpr double luminance(const Spectrum& s) {
  return 0.2126 * s.red + 0.7152 * s.green + 0.0722 * s.blue;
}

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
