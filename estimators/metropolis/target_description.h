#pragma once

// A target as a suite states it.

#include "estimators/parameters.h"
#include "metropolis/target.h"

namespace assay::metropolis {

/// `target` and `pixels`.
std::vector<ParameterInformation> target_parameters();

/// Reads them. A target is a name or a map with one key; all have exact means.
///   constant        1
///   peak            0.05 + 0.5 u + 40 e^(-((u - 0.3)^2 + (v - 0.7)^2) / (2 x 0.02^2))
///   coloured_peak   the same; each pixel has a colour of its own, red to blue
///   boundary        0.02 + e^(-20 u)
///   mixture, {mixture: {dimensions: D, base: b, lobes: [{height: h, centre: c, width: s}]}}
///                   Gaussian lobes on a base, in D dimensions
///   branches        32 stripes a pixel: 1 in even pixels, a narrow lobe of a second coordinate in
///                   odd ones
///   sphere, coloured_sphere, {sphere: {zones: [...], survival: q}}
///                   radiance of bands of a sphere's wall; zones as in paths/scene_description.h
///
/// InputError at the offending node: unknown names and keys, missing keys, numbers that are not
/// finite. Also an integrand that is negative or zero everywhere, widths that are not positive,
/// more than 32 coordinates or lobes. Also a survival outside (0, 1), and whatever scenes of paths
/// refuse.
SharedTarget read_target(Parameters& given);

}  // namespace assay::metropolis
