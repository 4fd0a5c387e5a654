// Direct light by multiple importance sampling of luminaire and BRDF, one of them drawn for every
// primary.

#include "direct_light/family.h"
#include "direct_light/samplers.h"

namespace assay::plugins {

namespace {

using namespace direct_light;

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const SharedTechniques techniques = read_techniques(given);
  const Pair probabilities = read_probabilities(given);
  const Heuristic heuristic = read_heuristic(given);
  const WeightedByHeuristic combination(heuristic, probabilities);
  // The bound of the multi-sample model, with one draw.
  KnownPrimary primary{.high = highest_of_brdf(*techniques) / probabilities.brdf};
  if (heuristic.smooth()) {
    if (const auto known = moments(*techniques, combination)) {
      primary.mean = known->radiance();
      primary.variance = known->one_sample_variance(probabilities);
    }
  }
  return averaging(radiance_channel(*techniques, primary),
                   OneSamplePrimary<>(techniques, probabilities, combination),
                   mixture_samplers(techniques, probabilities));
}

}  // namespace

std::vector<Entry> direct_light_one_sample() {
  return {
      {{.name = "direct_light/one_sample",
        .summary = "Light reflected towards a viewer, by one-sample multiple importance sampling.",
        .description =
            "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw by X = w_i f / (c_i p_i) with "
            "the technique i drawn, the luminaire with `light_probability` c_l, else the BRDF "
            "(Veach 1997, section 9.2.4, eq. 9.15). Weights as of direct_light/multi_sample with "
            "q = c p. By balance X = f / (c_l p_l + c_b p_b): importance sampling of the mixture, "
            "and no weights have less variance. Two such primaries with c = 1/2 have no less "
            "variance than one of the multi-sample model with a sample each. One ray a primary at "
            "most. Mean and variance as of direct_light/multi_sample. Sampler: mixture (of a "
            "polygon), a lobe for each technique.",
        .parameters = parameters_with({probability_parameter(), heuristic_parameter()})},
       prepare}};
}

}  // namespace assay::plugins
