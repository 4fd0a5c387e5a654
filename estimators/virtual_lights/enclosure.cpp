#include "virtual_lights/enclosure.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "paths/closed_mesh.h"

namespace assay::virtual_lights {

using render::TriangleMesh;
using render::Vector3;

namespace {

constexpr double flat = 1e-9;  // of the longest side

double longest_side(const TriangleMesh& mesh) {
  Vector3 low = mesh.vertices.front();
  Vector3 high = low;
  for (const Vector3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

TriangleMesh welded(const TriangleMesh& mesh) {
  std::map<std::tuple<double, double, double>, std::uint32_t> index;
  TriangleMesh out;
  std::vector<std::uint32_t> moved;
  for (const Vector3& v : mesh.vertices) {
    const auto [found, fresh] = index.emplace(std::tuple{v.x, v.y, v.z}, out.vertices.size());
    if (fresh) out.vertices.push_back(v);
    moved.push_back(found->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    out.triangles.push_back({moved[a], moved[b], moved[c]});
  }
  return out;
}

// Sets of triangles that have been found to belong together.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) { parent_[of(i)] = of(j); }
  bool all_one() {
    for (std::uint32_t i = 1; i < parent_.size(); ++i) {
      if (of(i) != of(0)) return false;
    }
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct Side {
  std::uint32_t triangle;
  std::uint32_t opposite;  ///< vertex
};

std::map<std::pair<std::uint32_t, std::uint32_t>, Side> sides(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Side> all;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    all[{a, b}] = {i, c};
    all[{b, c}] = {i, a};
    all[{c, a}] = {i, b};
  }
  return all;
}

// How far a point lies on the counter-clockwise side of a triangle's plane.
double height(const TriangleMesh& mesh, std::size_t triangle, const Vector3& point) {
  const auto [a, b, c] = mesh.corners(triangle);
  return dot(normalised(cross(b - a, c - a)), point - a);
}

void find_walls(const TriangleMesh& mesh, Enclosure& room) {
  Sets walls(mesh.triangles.size());
  Sets connected(mesh.triangles.size());
  const auto all = sides(mesh);
  const double tolerance = flat * longest_side(mesh);
  for (const auto& [edge, side] : all) {
    const Side& other = all.at({edge.second, edge.first});
    connected.join(side.triangle, other.triangle);
    const double out = height(mesh, side.triangle, mesh.vertices[other.opposite]);
    const double inwards = room.counter_clockwise ? out : -out;
    if (inwards < -tolerance) {
      room.why_not_convex = "its walls turn outwards at an edge";
      return;
    }
    if (inwards <= tolerance) walls.join(side.triangle, other.triangle);
  }
  if (!connected.all_one()) {
    room.why_not_convex = "its walls are not connected";
    return;
  }
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) room.wall_of.push_back(walls.of(i));
}

}  // namespace

Enclosure enclosure(const TriangleMesh& mesh, const Vector3& point) {
  const TriangleMesh whole = welded(mesh);
  Enclosure room{.why_open = paths::why_not_closed(whole)};
  if (room.why_open.empty()) {
    const int turns = paths::winding_number(whole, point);
    // Seen counter-clockwise from inside, the triangles' solid angles are negative.
    room.counter_clockwise = turns < 0;
    if (turns != 1 && turns != -1) room.why_open = "the receiver is not inside";
  }
  if (room.why_open.empty()) {
    find_walls(whole, room);
  } else {
    room.why_not_convex = room.why_open;
  }
  return room;
}

}  // namespace assay::virtual_lights
