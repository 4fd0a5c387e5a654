#include "virtual_lights/exact.h"

namespace assay::virtual_lights {

namespace {

// The share of the light on wall j that comes from elsewhere.
double reached(const std::vector<double>& shares, std::uint32_t wall, Weighting weighting) {
  const double elsewhere = 1 - shares[wall];
  if (weighting == Weighting::conditional) return elsewhere;
  // All power on one wall leaves nothing for it but rounding.
  return elsewhere > 1e-12 ? 1 : 0;
}

bool even_albedo(const Room& room) {
  const paths::MeshWorld& world = room.world();
  for (std::size_t i = 0; i < world.patches(); ++i) {
    if (!(world.surface(i).diffuse == world.surface(0).diffuse)) return false;
  }
  return true;
}

}  // namespace

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

std::optional<Spectrum> twice_reflected(const Room& room) {
  if (!room.even_emission()) return {};
  const paths::MeshWorld& world = room.world();
  const Spectrum first = room.receiver().surface->diffuse * *room.even_emission();
  if (even_albedo(room)) return first * world.surface(0).diffuse;
  const Enclosure& walls = room.walls();
  if (room.shininess() > 0 || !walls.why_not_convex.empty()) return {};
  const std::uint32_t own = walls.wall_of[room.receiver().patch / 2];
  Spectrum seen;
  for (std::size_t i = 0; i < walls.wall_of.size(); ++i) {
    if (walls.wall_of[i] != own) seen += room.form_factor(i) * world.surface(2 * i).diffuse;
  }
  return first * seen;
}

}  // namespace assay::virtual_lights
