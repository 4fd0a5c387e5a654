#pragma once

// A sphere of triangles that knows in which of them a direction lies.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/vector.h"

namespace assay::sky {

using render::Vector3;

/// The octahedron with every triangle cut into four, `level` times, new vertices moved out to the
/// unit sphere: 8 4^level planar triangles. The four parts of a triangle stand side by side, so
/// that the list is the leaves of a complete tree.
class Octahedron {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// `level` at most 9 (two million triangles); std::invalid_argument otherwise.
  explicit Octahedron(std::size_t level);

  std::size_t level() const { return levels_.size() - 1; }
  const std::vector<Vector3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return levels_.back(); }

  /// The triangle that the ray from the centre along w passes through.
  std::size_t triangle(const Vector3& w) const;
  std::array<Vector3, 3> corners(std::size_t triangle) const {
    const auto& [a, b, c] = triangles()[triangle];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }

 private:
  bool beyond(std::uint32_t a, std::uint32_t b, const Vector3& w) const {
    return dot(cross(vertices_[a], vertices_[b]), w) < 0;
  }

  std::vector<Vector3> vertices_;
  std::vector<std::vector<Triangle>> levels_;
};

}  // namespace assay::sky
