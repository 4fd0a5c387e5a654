#pragma once

// Rough estimates of the radiance that arrives at a surface.

#include <vector>

#include "paths/mesh_world.h"

namespace assay::paths {

/// Radiance that arrives on average, and the part of it that has been reflected at least once.
struct Incoming {
  Spectrum all;
  Spectrum reflected;
};

/// One estimate for the whole scene: what is emitted, times the geometric series of the mean
/// albedo.
Incoming global_incoming(const Spectrum& mean_emission, const Spectrum& mean_albedo);

/// Means over the area of a mesh, both sides alike.
Spectrum mean_emission(const MeshWorld& world);
Spectrum mean_albedo(const MeshWorld& world);

/// One estimate for each patch. `rays` rays from each, at fixed points along fixed directions, say
/// which patches it sees. Light is then passed around until it no longer changes. Adds the rays to
/// the cost.
std::vector<Incoming> local_incoming(const MeshWorld& world, std::size_t rays, Cost& cost);

}  // namespace assay::paths
