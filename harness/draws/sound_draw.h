#pragma once

#include "estimators/estimator.h"

namespace assay::harness {

/// The draw, with a point that lies outside the domain by rounding moved to the border. Rounding is
/// 1e-6 of the domain's size or the sampler's rounding(), whichever is more. Throws
/// std::runtime_error, in words for the sampler's author, if the point is farther outside, the
/// density is below 0, or the lobe does not exist. It also throws if a direction's length is not 1
/// within 1e-4 or rounding().
SamplerDraw sound(const NamedSampler& named, SamplerDraw draw);

/// The density at a point. Throws std::domain_error if it is negative or not finite.
double sound_density(const NamedSampler& named, const Point& point, double density);

}  // namespace assay::harness
