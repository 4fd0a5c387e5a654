#pragma once

// The common parts of the reflectance plugins: four samplers of reflected directions, and the
// directional albedo as the estimator.

#include <memory>
#include <vector>

#include "estimators/estimator.h"
#include "render/brdf/brdf.h"

namespace assay::brdf {

using SharedBrdf = std::shared_ptr<const render::HalfVectorBrdf>;

/// The sampler that the reflectance's paper gives, with p(w_o); directions below the horizon are
/// invalid draws of weight 0. evaluate = f cos.
std::shared_ptr<const Sampler> published_sampler(SharedBrdf);

/// Estimates the integral of f cos over the upper hemisphere, whose value stands in `channel`, by
/// the weights f cos / p of `sampler`.
std::shared_ptr<const Setup> albedo(Channel channel, std::shared_ptr<const Sampler> sampler);

/// Reads `sampler` and prepares that one. Mean and variance come from quadrature.
std::shared_ptr<const Setup> prepare_albedo(SharedBrdf, Parameters&);

Channel published_channel(const render::HalfVectorBrdf&);

/// theta_i, phi_i: shared by all reflectances.
std::vector<ParameterInformation> incident_parameters();
/// sampler.
ParameterInformation sampler_parameter();

}  // namespace assay::brdf
