#pragma once

// One path, whatever the world and the roulette.

#include <array>
#include <cstdint>

#include "estimators/cost.h"
#include "estimators/stream.h"
#include "paths/roulette.h"

namespace assay::paths {

/// The light of a path, and its number of vertices at each bounce. Bounce 0 is what the camera
/// sees.
struct Tally {
  static constexpr std::size_t bounces = 7;

  Spectrum value;
  std::uint64_t vertices = 0;
  std::array<std::uint64_t, bounces> at_bounce{};

  void count(std::size_t bounce) {
    ++vertices;
    if (bounce < bounces) ++at_bounce[bounce];
  }
};

/// The score of a vertex by itself. Emission counts if the path arrived by the camera's ray or a
/// mirror. Elsewhere it counts only if light is found by hits.
template <class World>
Spectrum score(const World& world, const Vertex& v, Direct direct, bool sees_emission,
               Stream& random, Cost& cost) {
  const Spectrum emission =
      sees_emission || direct == Direct::hit ? v.surface->emission : Spectrum{};
  if (direct == Direct::hit || v.surface->diffuse == Spectrum{}) return emission;
  return emission + world.direct_light(v, direct, random, cost);
}

/// A path with roulette at every vertex; `World` and `Roulette` are templates so that a mutant
/// can replace a part of either.
template <class World, class Roulette>
void trace(const World& world, const Roulette& roulette, Direct direct, Stream& random,
           Tally& tally, Cost& cost) {
  Spectrum throughput = Spectrum::grey(1);
  bool sees_emission = true;
  Vertex v = world.camera(cost);
  for (std::size_t bounce = 0; v.surface; ++bounce) {
    tally.count(bounce);
    tally.value += throughput * score(world, v, direct, sees_emission, random, cost);
    const Surface& surface = *v.surface;
    const Survival s = roulette.survival(throughput, surface);
    const Spectrum terminal = roulette.terminal(v);
    const double u = random.uniform();
    if (u >= s.total()) {
      tally.value += throughput * roulette.on_end(terminal);
      return;
    }
    tally.value += throughput * roulette.on_going_on(terminal, s.total());
    sees_emission = u >= s.diffuse;
    if (sees_emission) {
      throughput = roulette.continued(throughput, surface.mirror, s.mirror);
      v = world.mirrored(v, cost);
    } else {
      throughput = roulette.continued(throughput, surface.diffuse, s.diffuse);
      v = world.reflected(v, random, cost);
    }
  }
}

}  // namespace assay::paths
