#pragma once

// Tests if triangles enclose a point, and how. A room's light has a closed form only after that.

#include <cstdint>
#include <string>
#include <vector>

#include "render/triangle_mesh.h"

namespace assay::virtual_lights {

struct Enclosure {
  /// Why the triangles do not enclose the point; empty where they do.
  std::string why_open;
  /// Why they do not form one convex room; empty where they do.
  std::string why_not_convex;
  /// True if triangles are seen counter-clockwise from inside.
  bool counter_clockwise = true;
  /// The wall that each triangle is part of, in a convex room: triangles of one plane share a
  /// number.
  std::vector<std::uint32_t> wall_of;
};

/// Vertices at the same position, bit by bit, are one. Walls are planes to 1e-9 of the longest side
/// of the mesh along an axis. Closed: every edge runs once each way, and the surface winds about
/// the point once. Convex: connected, and convex at every edge, which makes it convex as a whole
/// (Tietze 1928, Nakajima 1928).
Enclosure enclosure(const render::TriangleMesh& mesh, const render::Vector3& point);

}  // namespace assay::virtual_lights
