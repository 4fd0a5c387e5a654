// Direct light by sampling the luminaire: X = L f cos V / p at a point uniform in solid angle or in
// area, p its density per solid angle.

#include <limits>

#include "direct_light/family.h"
#include "direct_light/samplers.h"

namespace assay::plugins {

namespace {

using namespace direct_light;

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const SharedTechniques techniques = read_techniques(given);
  const WeightedByHeuristic alone(Heuristic::balance(), {1, 0});
  KnownPrimary primary{.high = std::numeric_limits<double>::infinity()};
  if (const auto known = moments(*techniques, alone)) {
    primary.mean = known->radiance();
    primary.variance = known->one_sample_variance({1, 0});
  }
  return averaging(
      radiance_channel(*techniques, primary),
      [techniques, alone](Stream& random, Cost& cost) {
        return from_light(alone, techniques->light(random, cost));
      },
      light_samplers(techniques));
}

}  // namespace

std::vector<Entry> direct_light_light() {
  return {{{.name = "direct_light/light",
            .summary = "Light reflected towards a viewer, by sampling the luminaire.",
            .description =
                "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw, what a surface reflects "
                "towards a viewer of the light that arrives from a luminaire past occluders, by X "
                "= L f cos+ [visible] / p at points of the luminaire. p is per solid angle: 1 / "
                "Omega of directions uniform in the solid angle, distance^2 / (A cos') of points "
                "uniform in area. One shadow ray a primary, none below the horizon. Varies much "
                "where the BRDF has a narrow lobe and the luminaire is large. Mean and variance "
                "are known by adaptive quadrature for polygons past up to eight convex polygons; "
                "of a Lambertian surface the mean is f times Lambert's formula. Sampler: light "
                "(of a polygon).",
            .parameters = parameters_with({})},
           prepare}};
}

}  // namespace assay::plugins
