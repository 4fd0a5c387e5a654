#include "virtual_lights/exact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace assay::virtual_lights {

namespace {

// Of light on wall j, the share that comes from elsewhere.
double reached(const std::vector<double>& shares, std::uint32_t wall, Weighting weighting) {
  const double elsewhere = 1 - shares[wall];
  if (weighting == Weighting::conditional) return elsewhere;
  // All power on one wall leaves nothing for it but rounding.
  return elsewhere > 1e-12 ? 1 : 0;
}

// The receiver is moved off its own plane by this much at most, in units of the longest side: by
// paths::mesh_resolution / 4 of the radius of an inscribed circle, which is half at most.
constexpr double own_plane = paths::mesh_resolution / 4;

bool even_albedo(const Room& room) {
  const paths::MeshWorld& world = room.world();
  for (std::size_t i = 0; i < world.patches(); ++i) {
    if (!(world.surface(i).diffuse == world.surface(0).diffuse)) return false;
  }
  return true;
}

Spectrum largest_albedo(const Room& room) {
  const paths::MeshWorld& world = room.world();
  Spectrum most;
  for (std::size_t i = 0; i < world.patches(); ++i) {
    const Spectrum& albedo = world.surface(i).diffuse;
    most = {std::max(most.red, albedo.red), std::max(most.green, albedo.green),
            std::max(most.blue, albedo.blue)};
  }
  return most;
}

// How far a point of a triangle is moved at most (paths/mesh_world.cpp), and the triangle's plane.
struct Moved {
  double along = 0;
  double off = 0;
  render::Vector3 normal;
  double distance = 0;  // of the receiver to the plane
};

Moved moved(const std::array<render::Vector3, 3>& corners, const render::Vector3& receiver) {
  const auto& [a, b, c] = corners;
  const double at_a = length(c - b), at_b = length(a - c), at_c = length(b - a);
  const double around = at_a + at_b + at_c;
  const render::Vector3 centre = (at_a * a + at_b * b + at_c * c) / around;
  const render::Vector3 across = cross(b - a, c - a);
  const double radius = length(across) / around;
  const double shift = std::min(0.5, std::max(paths::mesh_resolution, paths::least_shift / radius));
  const double farthest = std::max({length(a - centre), length(b - centre), length(c - centre)});
  const render::Vector3 normal = normalised(across);
  return {shift * farthest, shift / 4 * radius, normal, std::abs(dot(normal, receiver - a))};
}

bool same_plane(const Moved& one, const Moved& other) {
  constexpr double rounding = 1e-9;  // of the longest side of the scene, which is 1
  return std::abs(one.distance - other.distance) < rounding &&
         length(one.normal - other.normal) < rounding;
}

// The sum over planes of what a form factor may be off, as in the header. The receiver sees nothing
// of a plane that it lies in.
double off_by_moving(const Room& room) {
  const render::TriangleMesh& mesh = room.world().mesh();
  std::vector<Moved> planes;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Moved one = moved(mesh.corners(i), room.receiver().position);
    const auto found =
        std::ranges::find_if(planes, [&](const Moved& plane) { return same_plane(plane, one); });
    if (found == planes.end()) {
      planes.push_back(one);
    } else {
      found->along = std::max(found->along, one.along);
      found->off = std::max(found->off, one.off);
    }
  }
  const double along = 0.53 + 0.193 * static_cast<double>(room.walls().outward_edges);
  double sum = 0;
  for (const Moved& plane : planes) {
    if (plane.distance > own_plane) sum += (along * plane.along + plane.off) / plane.distance;
  }
  return sum;
}

}  // namespace

Known target_integral(const Room& room, Weighting weighting) {
  if (weighting == Weighting::marginal && room.even_emission()) return {1};
  const Enclosure& walls = room.walls();
  if (!walls.why_open.empty()) {
    return {{}, "known only in a closed room, and this one is open: " + walls.why_open};
  }
  if (!walls.why_not_convex.empty()) {
    return {{}, "known only in a convex room; of this one " + walls.why_not_convex};
  }
  const std::vector<double> shares = room.shares_of_power();
  const std::uint32_t own = walls.wall_of[room.receiver().patch / 2];
  double sum = 0;
  for (std::size_t i = 0; i < walls.wall_of.size(); ++i) {
    if (walls.wall_of[i] == own) continue;
    sum += room.form_factor(i) * reached(shares, walls.wall_of[i], weighting);
  }
  return {sum};
}

std::optional<Stated> twice_reflected(const Room& room) {
  if (!room.even_emission()) return {};
  const paths::MeshWorld& world = room.world();
  const Spectrum first = room.receiver().surface->diffuse * *room.even_emission();
  const Spectrum error = off_by_moving(room) * (first * largest_albedo(room));
  if (even_albedo(room)) return Stated{first * world.surface(0).diffuse, error};
  const Enclosure& walls = room.walls();
  if (!walls.why_not_convex.empty()) return {};
  const std::uint32_t own = walls.wall_of[room.receiver().patch / 2];
  Spectrum seen;
  for (std::size_t i = 0; i < walls.wall_of.size(); ++i) {
    if (walls.wall_of[i] != own) seen += room.form_factor(i) * world.surface(2 * i).diffuse;
  }
  return Stated{first * seen, error};
}

}  // namespace assay::virtual_lights
