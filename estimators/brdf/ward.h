#pragma once

#include <vector>

#include "estimators/parameters.h"
#include "render/brdf/brdf_ward.h"

namespace assay::brdf {

/// alpha_x, alpha_y, theta_i, phi_i.
std::vector<ParameterInformation> ward_parameters();
/// Reads them; `Brdf` is constructible as Ward is.
template <class Brdf = render::Ward>
Brdf ward(Parameters&);

template <class Brdf>
Brdf ward(Parameters& parameters) {
  const double x = parameters.number("alpha_x");
  const double y = parameters.number("alpha_y");
  const double theta = parameters.number("theta_i");
  const double phi = parameters.number("phi_i");
  return Brdf({.x = x, .y = y}, {.theta = theta, .phi = phi});
}

}  // namespace assay::brdf
