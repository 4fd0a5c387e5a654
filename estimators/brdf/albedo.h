#pragma once

// The common parts of the reflectance plugins: four samplers of reflected directions, and the
// directional albedo as the estimator.

#include <memory>
#include <type_traits>
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

/// Reads theta_i and phi_i.
inline render::Angles read_incident(Parameters& given) {
  return {.theta = given.number("theta_i"), .phi = given.number("phi_i")};
}

/// nu, nv, reflectance, theta_i, phi_i.
std::vector<ParameterInformation> ashikhmin_shirley_parameters();
/// alpha_x, alpha_y, theta_i, phi_i.
std::vector<ParameterInformation> ward_parameters();

/// Reads those of the one that `Brdf` is or derives from; it is constructible as that one is.
template <class Brdf>
std::shared_ptr<const Brdf> read(Parameters& given) {
  if constexpr (std::is_base_of_v<render::Ward, Brdf>) {
    return std::make_shared<Brdf>(
        render::Roughness{.x = given.number("alpha_x"), .y = given.number("alpha_y")},
        read_incident(given));
  } else {
    return std::make_shared<Brdf>(
        typename Brdf::Material{.exponents = {.u = given.number("nu"), .v = given.number("nv")},
                                .reflectance = given.number("reflectance")},
        read_incident(given));
  }
}

}  // namespace assay::brdf
