#pragma once

// The exact light of a room, without sampling.

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

/// G, the integral of the target over the points that the shooting can reach. The target is the
/// density by area of y1 in the receiver's diffuse reflection, cos cos' V / (pi r^2).
///
/// A convex room has G by form factors F of its walls. The conditional density sums F times the
/// share of power that is not on the wall itself. The marginal density sums F over the walls that
/// some light reaches; it has G = 1 in any closed room that emits evenly.
Known target_integral(const Room& room, Weighting weighting);

/// The radiance that the receiver sends after exactly two reflections in a closed room that emits
/// evenly, in units of Le. It is a Le a' if all walls reflect a', and a Le sum F a' of a convex
/// room.
///
/// It is that of the scene as described. Shooting moves its points (paths::mesh_resolution), which
/// changes virtual lights by some 2^-14 of a wall's length over the receiver's distance to the
/// nearest other wall. That is 1e-4 in the middle of a cube, and up to a hundredth at a 200th of
/// its side from two walls.
std::optional<Spectrum> twice_reflected(const Room& room);

}  // namespace assay::virtual_lights
