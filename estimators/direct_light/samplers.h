#pragma once

// The directions of direct lighting as samplers, with the densities that weights are made of.

#include <vector>

#include "direct_light/techniques.h"
#include "estimators/estimator.h"

namespace assay::direct_light {

/// `light`: of a planar luminaire that emits towards the receiver, else nothing.
std::vector<NamedSampler> light_samplers(const SharedTechniques&);
/// `brdf`, with directions below the horizon as invalid draws.
std::vector<NamedSampler> brdf_samplers(const SharedTechniques&);
/// `mixture` of both with these probabilities, a lobe each; where there is `light`.
std::vector<NamedSampler> mixture_samplers(const SharedTechniques&, const Pair& probabilities);

}  // namespace assay::direct_light
