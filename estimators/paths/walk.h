#pragma once

// The plainest path: it goes on with the same probability wherever it is.

#include "estimators/cost.h"
#include "paths/path.h"

namespace assay::paths {

/// Adds the light of a path from `v` on to the tally. It is the sum of T_k Le_k, with T_0 = 1 and
/// T_k+1 = T_k a_k / survival. The type `Random` gives uniform numbers in [0, 1). It is a stream,
/// or coordinates that a Markov chain has mutated. A vertex takes one number to decide to go on,
/// one more at a mirror, and two for a diffuse direction.
template <class World, class Random>
void walk(const World& world, Vertex v, double survival, Random& random, Tally& tally, Cost& cost) {
  Spectrum throughput = Spectrum::grey(1);
  for (std::size_t bounce = 0; v.surface; ++bounce) {
    tally.count(bounce);
    tally.value += throughput * v.surface->emission;
    if (random.uniform() >= survival) return;
    const bool mirrors = !(v.surface->mirror == Spectrum{});
    if (mirrors && random.uniform() < 0.5) {
      throughput = 2 / survival * (throughput * v.surface->mirror);
      v = world.mirrored(v, cost);
    } else {
      throughput = (mirrors ? 2 : 1) / survival * (throughput * v.surface->diffuse);
      v = world.reflected(v, random, cost);
    }
  }
}

}  // namespace assay::paths
