#pragma once

#include "estimators/stream.h"
#include "render/brdf/brdf.h"

namespace assay::render {

/// A direction of the upper hemisphere with density proportional to a target of the reflectance. It
/// rejects from the proposal cos theta_o = xi^2, q = 1 / (4 pi sqrt(cos theta_o)): Ward's f grows
/// like 1 / sqrt(cos theta_o), so a uniform proposal would be wrong. It redraws until it accepts.
/// That is the algorithm, so no mass is missing. std::logic_error if the target exceeds the
/// reflectance's `rejection_bound` by more than rounding.
Vector3 sample_by_rejection(const HalfVectorBrdf&, Target, Stream&);

}  // namespace assay::render
