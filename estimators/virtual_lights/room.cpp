#include "virtual_lights/room.h"

#include <boost/pending/disjoint_sets.hpp>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "estimators/core/mapped.h"
#include "paths/scene_description.h"

namespace assay::virtual_lights {

using paths::MeshWorld;
using render::TriangleMesh;
using render::Vector3;
using std::numbers::pi;

namespace {

constexpr double flat = 1e-9;  // of the longest side

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
  // Triangles that have been found to belong together.
  using Sets = boost::disjoint_sets_with_storage<>;
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  Sets walls(count);
  Sets connected(count);
  const auto all = sides(mesh);
  const double tolerance = flat * render::Box(mesh).longest_side();
  for (const auto& [edge, side] : all) {
    const Side& other = all.at({edge.second, edge.first});
    connected.union_set(side.triangle, other.triangle);
    const double out = height(mesh, side.triangle, mesh.vertices[other.opposite]);
    const double inwards = room.counter_clockwise ? out : -out;
    if (inwards < -tolerance) {
      room.why_not_convex = "its walls turn outwards at an edge";
      return;
    }
    if (inwards <= tolerance) walls.union_set(side.triangle, other.triangle);
  }
  for (std::uint32_t i = 1; i < count; ++i) {
    if (connected.find_set(i) == connected.find_set(0u)) continue;
    room.why_not_convex = "its walls are not connected";
    return;
  }
  room.wall_of = mapped_indices(
      count, [&](std::size_t i) { return static_cast<std::uint32_t>(walls.find_set(i)); });
}

std::vector<std::uint32_t> emitting_sides(const MeshWorld& world, const Enclosure& room) {
  std::vector<std::uint32_t> sides;
  for (std::uint32_t i = 0; i < world.patches(); ++i) {
    const bool inner = (i % 2 == 0) == room.counter_clockwise;
    const bool may = !room.why_open.empty() || inner;
    if (may && render::largest(world.surface(i).emission) > 0) sides.push_back(i);
  }
  return sides;
}

// The share of the light on wall j that comes from elsewhere.
double reached(const std::vector<double>& shares, std::uint32_t wall, Weighting weighting) {
  const double elsewhere = 1 - shares[wall];
  if (weighting == Weighting::conditional) return elsewhere;
  // All power on one wall leaves nothing for it but rounding.
  return elsewhere > 1e-12 ? 1 : 0;
}

bool is_even(const MeshWorld& world, Rgb paths::Surface::*property) {
  for (std::size_t i = 0; i < world.patches(); ++i) {
    if (world.surface(i).*property != world.surface(0).*property) return false;
  }
  return true;
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

Room::Room(paths::SharedMesh world, double shininess)
    : world_(std::move(world)),
      shininess_(shininess),
      receiver_(world_->camera(Uncounted())),
      enclosure_(enclosure(world_->mesh(), receiver_.position)),
      sides_(emitting_sides(*world_, enclosure_)),
      lamps_(mapped(sides_, [](std::uint32_t side) { return side / 2; })),
      shares_(mapped(sides_, [&](std::uint32_t i) {
        return world_->patch_area(i) * render::mean(world_->surface(i).emission);
      })) {
  if (enclosure_.why_open.empty() && is_even(*world_, &paths::Surface::emission)) {
    even_emission_ = world_->surface(0).emission;
  }
  if (!even_emission_ && !enclosure_.why_not_convex.empty()) {
    why_no_marginal_ =
        "known only in a closed room that is convex or emits evenly; this one does not emit "
        "evenly, and " +
        enclosure_.why_not_convex;
  }
}

LightPath Room::shoot(Stream& random, Cost& cost) const {
  const auto [index, x, y] = shares_.choose(random);
  LightPath path{.from = world_->on_patch(sides_[index], x, y)};
  path.at = world_->reflected(path.from, random, cost);
  const Rgb& emission = path.from.surface->emission;
  path.power = pi * shares_.total() / render::mean(emission) * emission;
  return path;
}

double Room::geometry(const Vertex& light) const {
  const Vector3 way = light.position - receiver_.position;
  const double square = squared_length(way);
  const double here = dot(way, receiver_.normal);
  const double there = -dot(way, light.normal);
  if (!(here > 0 && there > 0)) return 0;
  return here * there / (square * square) * lobe(here / std::sqrt(square));
}

Rgb Room::reflected(const LightPath& path, double geometry) const {
  return geometry / (pi * pi) *
         (path.power * path.at.surface->diffuse * receiver_.surface->diffuse);
}

double Room::form_factor(const Vertex& from, std::size_t triangle) const {
  // Back on the plane that the vertex was lifted off, so that walls end where its horizon does.
  const auto wall = world_->mesh().corners(from.patch / 2);
  const Vector3 origin = from.position - dot(from.position - wall[0], from.normal) * from.normal;
  std::array<Vector3, 3> seen = world_->mesh().corners(triangle);
  for (Vector3& v : seen) v = v - origin;
  return render::lambert(seen, from.normal) / pi;
}

double Room::marginal_density(const Vertex& at) const {
  if (even_emission_) return render::mean(*even_emission_) / shares_.total();
  double irradiance = 0;
  for (const std::uint32_t lamp : lamps_) {
    if (enclosure_.wall_of[lamp] == enclosure_.wall_of[at.patch / 2]) continue;
    irradiance += brightness(lamp) * form_factor(at, lamp);
  }
  return irradiance / shares_.total();
}

std::vector<double> Room::shares_of_power() const {
  std::vector<double> shares(enclosure_.wall_of.size());
  for (const std::uint32_t lamp : lamps_) {
    shares[enclosure_.wall_of[lamp]] +=
        world_->patch_area(2 * std::size_t{lamp}) * brightness(lamp) / shares_.total();
  }
  return shares;
}

Known target_integral(const Room& room, Weighting weighting) {
  if (weighting == Weighting::marginal && room.even_emission()) return {1};
  if (room.shininess() > 0) {
    return {{}, "known of a glossy receiver only with marginal weights where emission is even"};
  }
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

std::optional<Rgb> twice_reflected(const Room& room) {
  if (!room.even_emission()) return {};
  const paths::MeshWorld& world = room.world();
  const Rgb first = room.receiver().surface->diffuse * *room.even_emission();
  if (is_even(world, &paths::Surface::diffuse)) return first * world.surface(0).diffuse;
  const Enclosure& walls = room.walls();
  if (room.shininess() > 0 || !walls.why_not_convex.empty()) return {};
  const std::uint32_t own = walls.wall_of[room.receiver().patch / 2];
  Rgb seen;
  for (std::size_t i = 0; i < walls.wall_of.size(); ++i) {
    if (walls.wall_of[i] != own) seen += room.form_factor(i) * world.surface(2 * i).diffuse;
  }
  return first * seen;
}

}  // namespace assay::virtual_lights
