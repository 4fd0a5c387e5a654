#pragma once

// What is known of the light of a room without sampling it.

#include <optional>
#include <string>

#include "virtual_lights/room.h"

namespace assay::virtual_lights {

/// The density that the target is divided by.
enum class Weighting {
  conditional,  ///< of y1 given y0, in the space of paths
  marginal,     ///< of y1
};

/// A number, or why it is not known.
struct Known {
  std::optional<double> value = {};
  std::string why_not = {};
};

/// G, the integral of the target over what the shooting can reach; the target is the density by
/// area of y1 as the receiver's diffuse reflection would choose it, cos cos' V / (pi r^2). By form
/// factors F of the walls of a convex room: conditional, sum of F times the share of power that is
/// not on the wall itself; marginal, sum of F over the walls that some light reaches. 1 for the
/// marginal density in any closed room that emits evenly.
Known target_integral(const Room& room, Weighting weighting);

/// The radiance that the receiver sends after exactly two reflections in a closed room that emits
/// evenly: a Le a' of walls that reflect a' all, and a Le sum F a' of a convex room; in units of
/// Le. Of the scene as it is described: rays of shooting start and end at points that are moved
/// (paths::mesh_resolution), which changes what virtual lights bring by some 2^-14 of a wall's
/// length over the receiver's distance to the nearest other wall: 1e-4 in the middle of a cube, up
/// to a hundredth at a 200th of its side from two walls.
std::optional<Spectrum> twice_reflected(const Room& room);

}  // namespace assay::virtual_lights
