#pragma once

// What a draw and a declared density must be before a claim can be about them.

#include "estimators/estimator.h"

namespace assay::harness {

/// The draw with its point in the domain: the same bits where it was there, and at the border where
/// rounding had put it outside, by 1e-6 of the domain's size or the sampler's rounding(), whichever
/// is more. Throws std::runtime_error, in words for its author, where no claim can be about it: the
/// point is farther outside, or a direction whose length is not 1 within 1e-4 or rounding(); the
/// density is below 0; the sampler has no such lobe.
SamplerDraw sound(const NamedSampler& named, SamplerDraw draw);

/// The density that a sampler declares at a point. Throws std::domain_error where it is below 0 or
/// not finite.
double sound_density(const NamedSampler& named, const Point& point, double density);

}  // namespace assay::harness
