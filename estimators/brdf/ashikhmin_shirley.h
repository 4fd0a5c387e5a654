#pragma once

#include <vector>

#include "estimators/parameters.h"
#include "render/brdf/brdf_ashikhmin_shirley.h"

namespace assay::brdf {

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

}  // namespace assay::brdf
