#pragma once

// The common parts of the reflectance plugins: four samplers of reflected directions, and the
// directional albedo as the estimator.

#include <memory>
#include <vector>

#include "estimators/estimator.h"
#include "estimators/parameters.h"
#include "render/brdf.h"

namespace assay::brdf {

using SharedBrdf = std::shared_ptr<const render::HalfVectorBrdf>;

/// The sampler that the reflectance's paper gives, with p(w_o); directions below the horizon are
/// invalid draws of weight 0. evaluate = f cos.
std::shared_ptr<const Sampler> published_sampler(SharedBrdf);

/// Estimates the integral of f cos over the upper hemisphere, whose value stands in `channel`, by
/// the weights f cos / p of `sampler`.
std::shared_ptr<const Setup> albedo(Channel channel, std::shared_ptr<const Sampler> sampler);

Channel published_channel(const render::HalfVectorBrdf&);

/// sampler.
ParameterInformation sampler_parameter();

/// nu, nv, reflectance, theta_i, phi_i.
std::vector<ParameterInformation> ashikhmin_shirley_parameters();

/// Reads them; `Brdf` is constructible as AshikhminShirley is.
template <class Brdf = render::AshikhminShirley>
Brdf ashikhmin_shirley(Parameters& parameters) {
  const double u = parameters.number("nu");
  const double v = parameters.number("nv");
  const double reflectance = parameters.number("reflectance");
  const double theta = parameters.number("theta_i");
  const double phi = parameters.number("phi_i");
  return Brdf({.exponents = {.u = u, .v = v}, .reflectance = reflectance},
              {.theta = theta, .phi = phi});
}

/// alpha_x, alpha_y, theta_i, phi_i.
std::vector<ParameterInformation> ward_parameters();
/// Reads them; `Brdf` is constructible as Ward is.
template <class Brdf = render::Ward>
Brdf ward(Parameters& parameters) {
  const double x = parameters.number("alpha_x");
  const double y = parameters.number("alpha_y");
  const double theta = parameters.number("theta_i");
  const double phi = parameters.number("phi_i");
  return Brdf({.x = x, .y = y}, {.theta = theta, .phi = phi});
}

}  // namespace assay::brdf
