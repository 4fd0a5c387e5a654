#include "virtual_lights/room.h"

#include <numbers>
#include <utility>

namespace assay::virtual_lights {

using paths::MeshWorld;
using render::Vector3;
using std::numbers::pi;

namespace {

Vertex seen_by_camera(const MeshWorld& world) {
  Cost counted_by_the_set_up;
  return world.camera(counted_by_the_set_up);
}

std::vector<std::uint32_t> emitting_sides(const MeshWorld& world, const Enclosure& room) {
  std::vector<std::uint32_t> sides;
  for (std::uint32_t i = 0; i < world.patches(); ++i) {
    const bool inner = (i % 2 == 0) == room.counter_clockwise;
    const bool may = !room.why_open.empty() || inner;
    if (may && paths::largest(world.surface(i).emission) > 0) sides.push_back(i);
  }
  return sides;
}

std::vector<double> powers(const MeshWorld& world, const std::vector<std::uint32_t>& sides) {
  std::vector<double> list;
  for (const std::uint32_t i : sides) {
    list.push_back(world.patch_area(i) * paths::mean(world.surface(i).emission));
  }
  return list;
}

std::vector<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& sides) {
  std::vector<std::uint32_t> triangles;
  for (const std::uint32_t side : sides) triangles.push_back(side / 2);
  return triangles;
}

}  // namespace

Room::Room(paths::SharedMesh world, double shininess)
    : world_(std::move(world)),
      shininess_(shininess),
      receiver_(seen_by_camera(*world_)),
      enclosure_(enclosure(world_->mesh(), receiver_.position)),
      sides_(emitting_sides(*world_, enclosure_)),
      lamps_(triangles_of(sides_)),
      shares_(powers(*world_, sides_)),
      even_emission_(find_even_emission()) {
  if (!even_emission_ && !enclosure_.why_not_convex.empty()) {
    why_no_marginal_ =
        "known only in a closed room that is convex or emits evenly; this one does not emit "
        "evenly, and " +
        enclosure_.why_not_convex;
  }
}

std::optional<Spectrum> Room::find_even_emission() const {
  if (!enclosure_.why_open.empty()) return {};
  const Spectrum& emission = world_->surface(0).emission;
  for (std::size_t i = 0; i < world_->patches(); ++i) {
    if (!(world_->surface(i).emission == emission)) return {};
  }
  return emission;
}

LightPath Room::shoot(Stream& random, Cost& cost) const {
  double x = random.uniform();
  const std::uint32_t side = sides_[shares_.pick(x)];
  const double y = random.uniform();
  LightPath path{.from = world_->on_patch(side, x, y)};
  path.at = world_->reflected(path.from, random, cost);
  const Spectrum& emission = path.from.surface->emission;
  path.power = pi * shares_.total() / paths::mean(emission) * emission;
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

Spectrum Room::reflected(const LightPath& path, double geometry) const {
  return geometry / (pi * pi) *
         (path.power * path.at.surface->diffuse * receiver_.surface->diffuse);
}

double Room::conditional_density(const LightPath& path) {
  return path.from_cosine() * path.at_cosine() / (pi * path.squared_distance());
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
  if (even_emission_) return paths::mean(*even_emission_) / shares_.total();
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

}  // namespace assay::virtual_lights
