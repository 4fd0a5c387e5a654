#include "paths/closed_mesh.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace assay::paths {

using render::TriangleMesh;
using render::Vector3;

std::string why_not_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& edge : {std::pair{a, b}, {b, c}, {c, a}}) ++count[edge];
  }
  for (const auto& [edge, times] : count) {
    const auto& [from, to] = edge;
    const std::string name = "the edge between its vertices " + std::to_string(from + 1) + " and " +
                             std::to_string(to + 1);
    if (times > 1) return name + " is run through twice the same way";
    if (!count.contains({to, from})) return name + " belongs to one triangle only";
  }
  return "";
}

int winding_number(const TriangleMesh& mesh, const Vector3& point) {
  double angle = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [p, q, r] = mesh.corners(i);
    const Vector3 a = p - point;
    const Vector3 b = q - point;
    const Vector3 c = r - point;
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    angle += 2 * std::atan2(dot(a, cross(b, c)),
                            la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return static_cast<int>(std::lround(angle / (4 * std::numbers::pi)));
}

}  // namespace assay::paths
