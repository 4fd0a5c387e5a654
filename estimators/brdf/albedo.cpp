#include "brdf/albedo.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "estimators/parameters.h"
#include "render/brdf.h"

namespace assay::brdf {

namespace {

using render::Target;
using render::Vector3;
using render::vector_of;

/// Directions of `point` with `density`; evaluate() is f cos.
std::shared_ptr<const Sampler> brdf_sampler(const SharedBrdf& brdf,
                                            std::function<std::optional<Point>(Stream&)> point,
                                            std::function<double(const Point&)> density) {
  // Four standard deviations of the lobe to a part.
  const auto parts = [width = brdf->width()](double range) {
    return static_cast<std::size_t>(std::ceil(range / (4 * width)));
  };
  const auto evaluate = [brdf](const Point& p) {
    return p[2] > 0 ? brdf->target(Target::brdf_cosine, vector_of(p)) : 0;
  };
  return sampler_of(
      {.domain = Domain::hemisphere,
       .point = std::move(point),
       .density = std::move(density),
       .evaluate = evaluate,
       .panels = {.first = parts(std::numbers::pi / 2), .second = parts(2 * std::numbers::pi)}});
}

/// `integral` of the target over the upper hemisphere.
std::shared_ptr<const Sampler> rejection_sampler(const SharedBrdf& brdf, Target target,
                                                 double integral) {
  const auto point_above = [brdf, target](Stream& random) {
    return point_of(render::sample_by_rejection(*brdf, target, random));
  };
  const auto density = [brdf, target, integral](const Point& p) {
    return p[2] > 0 ? brdf->target(target, vector_of(p)) / integral : 0;
  };
  return brdf_sampler(brdf, point_above, density);
}

Channel channel(const render::BrdfIntegrals& integrals, double second_moment, double bound) {
  const double mean = integrals.albedo;
  return {.name = "albedo",
          .mean = mean,
          .mean_error = mean * integrals.error,
          .variance = second_moment - mean * mean,
          .low = 0,
          .high = bound};
}

/// Reads `sampler` and prepares that one. Mean and variance come from quadrature.
template <class Brdf>
std::shared_ptr<const Setup> prepare_albedo(Parameters& parameters) {
  const SharedBrdf brdf = read<Brdf>(parameters);
  const std::string kind = parameters.string("sampler");
  if (kind == "published") return albedo(published_channel(*brdf), published_sampler(brdf));
  const render::BrdfIntegrals i = integrate(*brdf);
  if (kind == "density_rejection") {
    // f cos_o / (p / mass) <= mass times the bound of f cos_o / p.
    return albedo(channel(i, i.mass * i.second_moment, i.mass * brdf->weight_bound()),
                  rejection_sampler(brdf, Target::density, i.mass));
  }
  if (kind == "brdf_rejection") {
    // f cos_o / (f / B) = B cos_o <= B, of second moment B^2 E[cos_o^2] = B times that of f.
    return albedo(channel(i, i.brdf * i.cosine_moment, i.brdf),
                  rejection_sampler(brdf, Target::brdf, i.brdf));
  }
  // f cos_o / (f cos_o / albedo): the albedo whatever is drawn, to rounding. A weight is off by a
  // few units in the last place, a sum of many primaries by more.
  const double rounding = i.albedo * 0x1p-40;
  Channel constant = channel(i, i.albedo * i.albedo, i.albedo + rounding);
  constant.low = i.albedo - rounding;
  constant.rounding = 2 * rounding;
  return albedo(constant, rejection_sampler(brdf, Target::brdf_cosine, i.albedo));
}

std::vector<ParameterInformation> incident_parameters() {
  return {
      number_parameter("theta_i", "polar angle of the incident direction", "0.8", {0, 1.5}, "rad"),
      number_parameter("phi_i", "azimuth of the incident direction, from the x axis of the lobe",
                       "0.5", {0, 6.283185307179586}, "rad")};
}

}  // namespace

std::shared_ptr<const Sampler> published_sampler(SharedBrdf brdf) {
  const auto point_above = [brdf](Stream& random) {
    const Vector3 out = brdf->sample(random);
    return out.z > 0 ? std::optional(point_of(out)) : std::nullopt;
  };
  return brdf_sampler(brdf, point_above,
                      [brdf](const Point& p) { return brdf->density(vector_of(p)); });
}

Channel published_channel(const render::HalfVectorBrdf& brdf) {
  const render::BrdfIntegrals integrals = integrate(brdf);
  return channel(integrals, integrals.second_moment, brdf.weight_bound());
}

std::shared_ptr<const Setup> albedo(Channel channel, std::shared_ptr<const Sampler> sampler) {
  return averaging(std::move(channel),
                   [sampler](Stream& random) { return sampler->sample(random).weight; },
                   {{"direction", sampler}});
}

ParameterInformation sampler_parameter() {
  return text_parameter(
      "sampler",
      "how directions are drawn: as published, or by rejection from the published density above "
      "the horizon, from f, or from f cos",
      "published", {"published", "density_rejection", "brdf_rejection", "brdf_cosine_rejection"});
}

std::vector<ParameterInformation> ashikhmin_shirley_parameters() {
  return joined(
      {number_parameter("nu", "exponent along x", "10", {0, 10000}),
       number_parameter("nv", "exponent along y", "100", {0, 10000}),
       number_parameter("reflectance", "Fresnel reflectance at normal incidence (Schlick's)", "0.5",
                        {0, 1})},
      incident_parameters());
}

std::vector<ParameterInformation> ward_parameters() {
  return joined({number_parameter("alpha_x", "roughness along x", "0.15", {0.02, 1}),
                 number_parameter("alpha_y", "roughness along y", "0.4", {0.02, 1})},
                incident_parameters());
}

}  // namespace assay::brdf

namespace assay::plugins {

std::vector<Entry> brdf_albedo() {
  return {
      {{.name = "brdf/ashikhmin_shirley",
        .summary = "Directional albedo of the Ashikhmin-Shirley reflectance (specular part).",
        .description =
            "Estimates the integral of f cos over the upper hemisphere by f cos / p. f = "
            "sqrt((nu+1)(nv+1)) / (8 pi) (n.h)^e F(h.w_i) / ((h.w_i) max(cos_i, cos_o)), e = nu "
            "cos^2 phi + nv sin^2 phi, F Schlick's (Ashikhmin & Shirley 2000). The published "
            "sampler has the density p = sqrt((nu+1)(nv+1)) / (2 pi) (n.h)^e / (4 h.w_i) and the "
            "weight F cos_o / max(cos_i, cos_o); directions below the horizon are invalid draws of "
            "weight 0. With the default parameters p has the mass 0.916369 above the horizon and "
            "the albedo is 0.373217. The rejection samplers propose cos_o = xi^2 and are "
            "normalised by quadrature.",
        .parameters = joined(brdf::ashikhmin_shirley_parameters(), {brdf::sampler_parameter()})},
       brdf::prepare_albedo<render::AshikhminShirley>},
      {{.name = "brdf/ward",
        .summary = "Directional albedo of Ward's anisotropic reflectance.",
        .description =
            "Estimates the integral of f cos over the upper hemisphere by f cos / p. f = "
            "exp(-tan^2 d (cos^2 phi / ax^2 + sin^2 phi / ay^2)) / (4 pi ax ay sqrt(cos_i cos_o)), "
            "d and phi the angles of the half vector h (Ward 1992). The published sampler has the "
            "density p = exp(.) / (4 pi ax ay (h . w_i) cos^3 d) and the weight (h . w_i) cos^3 d "
            "sqrt(cos_o / cos_i) (Walter 2005); directions below the horizon are invalid draws of "
            "weight 0. With the default parameters p has the mass 0.980181 above the horizon and "
            "the albedo is 0.564185. The rejection samplers propose cos_o = xi^2, because f is "
            "unbounded where w_o grazes the surface, and are normalised by quadrature.",
        .parameters = joined(brdf::ward_parameters(), {brdf::sampler_parameter()})},
       brdf::prepare_albedo<render::Ward>}};
}

}  // namespace assay::plugins
