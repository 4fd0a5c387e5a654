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

/// A radiance, and what virtual lights may be off it.
struct Stated {
  Spectrum radiance;
  Spectrum error;
};

/// The radiance that the receiver sends after exactly two reflections in a closed room that emits
/// evenly: a Le a' of walls that reflect a' all, and a Le sum F a' of a convex room; in units of
/// Le. Of the scene as it is described: virtual lights stand at points that are moved
/// (paths::mesh_resolution), by s along their wall and by h off it at most. A wall whose plane the
/// receiver sees at the distance d then brings another form factor, to first order by
///
///     abs(dF) <= (0.414^2 + 0.319^2)^(1/2) s / d + h / d = (0.53 s + h) / d,
///
/// the integrals of abs(dk/dz), abs(dk/dy) and abs(dk/dd) over the half plane z > 0, k = z d /
/// (pi (y^2 + z^2 + d^2)^2); and by 0.193 s / d more for the shadow of each edge at which the room
/// turns outwards, the most that k adds up to along a line. `error` is a Le max(a') sum of these:
/// 3e-4 of the radiance in the middle of a cube, 1.2 % at a 200th of its side from two walls.
std::optional<Stated> twice_reflected(const Room& room);

}  // namespace assay::virtual_lights
