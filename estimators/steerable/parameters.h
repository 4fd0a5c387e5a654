#pragma once

// The parameters of steerable sampling.

#include <memory>
#include <vector>

#include "sky/setting.h"
#include "steerable/lobe.h"
#include "steerable/sky_tree.h"

namespace assay::steerable {

/// level, coefficients, offset, floor.
std::vector<ParameterInformation> parameters();

/// Coefficients and offset. InputError at `offset` when the lobe is not positive everywhere: a
/// density that is zero or negative where light comes from makes the estimate biased.
Lobe read_lobe(Parameters&);
/// The same without the check, for the sake of those that clamp.
Lobe read_any_lobe(Parameters&);

/// InputError at `floor` when the luminance is zero at a vertex of the subdivision: directions near
/// by might never be drawn.
std::shared_ptr<const SkyTree> read_tree(Parameters&, const sky::Setting&);

}  // namespace assay::steerable
