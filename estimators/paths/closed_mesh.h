#pragma once

// Tests if a mesh encloses a volume, and if a point lies in it.

#include <string>

#include "render/triangle_mesh.h"

namespace assay::paths {

/// Empty if every edge of a triangle is an edge of exactly one other, run through the opposite way.
/// Else a sentence that names an edge which is not (vertices counted from 1).
std::string why_not_closed(const render::TriangleMesh& mesh);

/// How often a closed mesh winds about a point: +-1 inside, 0 outside. The sum of the triangles'
/// signed solid angles (van Oosterom & Strackee 1983, eq. 8) over 4 pi, rounded.
int winding_number(const render::TriangleMesh& mesh, const render::Vector3& point);

}  // namespace assay::paths
