#pragma once

// Triangles with shared vertices, and the files they come from.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/polygon.h"

namespace assay::render {

struct TriangleMesh {
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  /// The vertices of one triangle in order.
  std::array<Vector3, 3> corners(std::size_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return {vertices[a], vertices[b], vertices[c]};
  }
};

/// The smallest box along the axes that holds all vertices, of which there is one or more.
struct Box {
  explicit Box(const TriangleMesh& mesh);

  Vector3 centre() const { return 0.5 * (low + high); }
  double longest_side() const;

  Vector3 low;
  Vector3 high;
};

/// A convex polygon as a fan of triangles about its first vertex; those without area are left out.
TriangleMesh fan(const Polygon& polygon);

/// Reads a Wavefront OBJ file: `v x y z`, `f`, comments and blank lines. A face has three or more
/// corners `v`, `v/vt`, `v//vn` or `v/vt/vn`, with positive (from 1) or negative (from the last)
/// indices. It becomes a fan about its first corner, so split a concave one. The statements vt vn g
/// o s usemtl mtllib have no effect.
///
/// InputError at `file:line` for a file that cannot be read or holds no face, and for any other
/// statement. The same for a malformed or non-finite number, an index out of range, and a face
/// without area.
TriangleMesh read_obj(const std::string& file);

}  // namespace assay::render
