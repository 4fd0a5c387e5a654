#pragma once

#include "estimators/stream.h"
#include "render/brdf.h"

namespace assay::render {

/// A direction of the upper hemisphere with density proportional to a target of the reflectance, by
/// rejection from the proposal cos theta_o = xi^2, q = 1 / (4 pi sqrt(cos theta_o)). (A uniform
/// proposal would be wrong: Ward's f grows like 1 / sqrt(cos theta_o).) Redraws until it accepts;
/// this is the algorithm, so no mass is missing. Throws std::logic_error when the target exceeds
/// the reflectance's `rejection_bound`, by more than rounding: the law would be another one.
Vector3 sample_by_rejection(const HalfVectorBrdf&, Target, Stream&);

}  // namespace assay::render
