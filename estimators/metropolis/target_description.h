#pragma once

// A target as a suite states it.

#include "estimators/parameters.h"
#include "metropolis/target.h"

namespace assay::metropolis {

/// `target` and `pixels`.
std::vector<ParameterInformation> target_parameters();

/// Reads them. A target is a name (constant, peak, coloured_peak, boundary, mixture, branches,
/// sphere, coloured_sphere) or a map with one key, as in estimators/README.md. InputError at the
/// offending node: unknown names and keys, missing keys, numbers that are not finite, an integrand
/// that is negative or zero everywhere, widths that are not positive, more than 32 coordinates or
/// lobes, a survival outside (0, 1), and what scenes of paths refuse.
SharedTarget read_target(Parameters& given);

}  // namespace assay::metropolis
