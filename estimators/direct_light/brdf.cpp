// Direct light by sampling the BRDF: X = L f cos / p along a direction of the reflectance, where
// the ray hits the luminaire first.

#include "direct_light/family.h"
#include "direct_light/samplers.h"

namespace assay::plugins {

namespace {

using namespace direct_light;

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const luminaire::SharedSetting setting = luminaire::read_setting(given);
  const auto techniques = std::make_shared<const Techniques>(setting, read_reflectance(given),
                                                             solid_angle_sampling(setting));
  const WeightedByHeuristic alone(Heuristic::balance(), {0, 1});
  KnownPrimary primary{.high = highest_of_brdf(*techniques)};
  if (const auto known = moments(*techniques, alone)) {
    primary.mean = known->radiance();
    primary.variance = known->one_sample_variance({0, 1});
  }
  return averaging(
      radiance_channel(*techniques, primary),
      [techniques, alone](Stream& random, Cost& cost) {
        return from_brdf(alone, techniques->brdf(random, cost));
      },
      brdf_samplers(techniques));
}

}  // namespace

std::vector<Entry> direct_light_brdf() {
  return {{{.name = "direct_light/brdf",
            .summary = "Light reflected towards a viewer, by sampling the BRDF.",
            .description =
                "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw, as direct_light/light "
                "does, by X = L f cos / p where a ray along a direction of the BRDF's sampler, of "
                "density p, first hits the side of the luminaire that emits, else 0. One closest "
                "hit a primary, none below the horizon. Varies much where the luminaire is small "
                "beside the lobe. X is never above L times the bound of f cos / p. Mean and "
                "variance as of direct_light/light. Sampler: brdf.",
            .parameters = common_parameters()},
           prepare}};
}

}  // namespace assay::plugins
