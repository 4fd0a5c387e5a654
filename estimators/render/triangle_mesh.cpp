#include "render/triangle_mesh.h"

namespace assay::render {

TriangleMesh fan(const Polygon& polygon) {
  TriangleMesh mesh{polygon, {}};
  for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector3 across = cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    if (squared_length(across) > 0) mesh.triangles.push_back({0, i, i + 1});
  }
  return mesh;
}

}  // namespace assay::render
