// The directional albedo of Ward's reflectance: E = the integral of f cos_o over the hemisphere.
//
// Directions are drawn by the half vector (render/brdf/brdf_ward.h). The published algorithm follows its
// own density p(w_o), so the weight f cos / p is not constant. Directions below the horizon count
// as zero: so the mean of the weights is the albedo.

#include "brdf/ward.h"

#include "brdf/albedo.h"

namespace assay::brdf {

std::vector<ParameterInformation> ward_parameters() {
  std::vector<ParameterInformation> all{{.name = "alpha_x",
                                         .summary = "roughness along x",
                                         .fallback = "0.15",
                                         .low = 0.02,
                                         .high = 1},
                                        {.name = "alpha_y",
                                         .summary = "roughness along y",
                                         .fallback = "0.4",
                                         .low = 0.02,
                                         .high = 1}};
  for (ParameterInformation& p : incident_parameters()) all.push_back(std::move(p));
  return all;
}

}  // namespace assay::brdf

namespace assay::plugins {

std::vector<Entry> brdf_ward() {
  std::vector<ParameterInformation> parameters = brdf::ward_parameters();
  parameters.push_back(brdf::sampler_parameter());
  return {{{.name = "brdf/ward",
            .summary = "Directional albedo of Ward's anisotropic reflectance.",
            .description =
                "Estimates the integral of f cos over the upper hemisphere by f cos / p. "
                "f = exp(-tan^2 d (cos^2 phi / ax^2 + sin^2 phi / ay^2)) / "
                "(4 pi ax ay sqrt(cos_i cos_o)), d and phi the angles of the half vector h (Ward "
                "1992). The published sampler has the density p = exp(.) / (4 pi ax ay (h . w_i) "
                "cos^3 d) and the weight (h . w_i) cos^3 d sqrt(cos_o / cos_i) (Walter 2005); what "
                "falls below the horizon is an invalid draw of weight 0. With the default "
                "parameters p has the mass 0.980181 above the horizon and the albedo is 0.564185. "
                "The rejection samplers propose cos_o = xi^2, because f is unbounded where w_o "
                "grazes the surface, and are normalised by quadrature.",
            .parameters = std::move(parameters)},
           [](Parameters& given) {
             const auto ward = std::make_shared<render::Ward>(brdf::ward(given));
             return brdf::prepare_albedo(ward, given);
           }}};
}

}  // namespace assay::plugins
