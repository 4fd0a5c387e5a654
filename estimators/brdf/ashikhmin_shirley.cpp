// The directional albedo of the Ashikhmin-Shirley reflectance (specular part): E = the integral of
// f cos_o over the hemisphere, by the half vector (render/brdf/brdf_ashikhmin_shirley.h). Like Ward's,
// the published algorithm follows its own p(w_o); directions below the horizon count as zero.

#include "brdf/ashikhmin_shirley.h"

#include "brdf/albedo.h"

namespace assay::brdf {

std::vector<ParameterInformation> ashikhmin_shirley_parameters() {
  std::vector<ParameterInformation> all{
      {.name = "nu", .summary = "exponent along x", .fallback = "10", .low = 0, .high = 10000},
      {.name = "nv", .summary = "exponent along y", .fallback = "100", .low = 0, .high = 10000},
      {.name = "reflectance",
       .summary = "Fresnel reflectance at normal incidence (Schlick's)",
       .fallback = "0.5",
       .low = 0,
       .high = 1}};
  for (ParameterInformation& p : incident_parameters()) all.push_back(std::move(p));
  return all;
}

}  // namespace assay::brdf

namespace assay::plugins {

std::vector<Entry> brdf_ashikhmin_shirley() {
  std::vector<ParameterInformation> parameters = brdf::ashikhmin_shirley_parameters();
  parameters.push_back(brdf::sampler_parameter());
  return {{{.name = "brdf/ashikhmin_shirley",
            .summary = "Directional albedo of the Ashikhmin-Shirley reflectance (specular part).",
            .description =
                "Estimates the integral of f cos over the upper hemisphere by f cos / p. "
                "f = sqrt((nu+1)(nv+1)) / (8 pi) (n.h)^e F(h.w_i) / ((h.w_i) max(cos_i, cos_o)), "
                "e = nu cos^2 phi + nv sin^2 phi, F Schlick's (Ashikhmin & Shirley 2000). The "
                "published sampler has the density p = sqrt((nu+1)(nv+1)) / (2 pi) (n.h)^e / "
                "(4 h.w_i) and the weight F cos_o / max(cos_i, cos_o); what falls below the "
                "horizon is an invalid draw of weight 0. With the default parameters p has the "
                "mass 0.916369 above the horizon and the albedo is 0.373217. The rejection "
                "samplers propose cos_o = xi^2 and are normalised by quadrature.",
            .parameters = std::move(parameters)},
           [](Parameters& given) {
             const auto brdf =
                 std::make_shared<render::AshikhminShirley>(brdf::ashikhmin_shirley(given));
             return brdf::prepare_albedo(brdf, given);
           }}};
}

}  // namespace assay::plugins
