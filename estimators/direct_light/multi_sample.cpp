// Direct light by multiple importance sampling of luminaire and BRDF, samples of both in every
// primary.

#include "direct_light/family.h"
#include "direct_light/samplers.h"

namespace assay::plugins {

namespace {

using namespace direct_light;

// For every heuristic of exponent 1 or more a weighted draw brings f / q_b at most, q_b = n_b p_b.
//   Balance: w_i f / q_i = f / (q_l + q_b).
//   Power: f q_i^(e-1) / (q_l^e + q_b^e) <= f / q_b, since x^(e-1) <= 1 + x^e.
//   Maximum and cutoff: f / q_i with q_i the larger, if the other is left out.
double highest(const Techniques& techniques, const Counts& counts) {
  const Pair n = counts.shares();
  return highest_of_brdf(techniques) * (n.light + n.brdf) / n.brdf;
}

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const SharedTechniques techniques = read_techniques(given);
  const Counts counts = read_counts(given);
  const Heuristic heuristic = read_heuristic(given);
  const WeightedByHeuristic combination(heuristic, counts.shares());
  KnownPrimary primary{.high = highest(*techniques, counts)};
  if (heuristic.smooth()) {
    if (const auto known = moments(*techniques, combination)) {
      primary.mean = known->radiance();
      primary.variance = known->multi_sample_variance(counts);
    }
  }
  std::vector<NamedSampler> samplers = light_samplers(techniques);
  samplers.push_back(brdf_samplers(techniques)[0]);
  return averaging(radiance_channel(*techniques, primary),
                   MultiSamplePrimary<>(techniques, counts, combination), std::move(samplers));
}

}  // namespace

std::vector<Entry> direct_light_multi_sample() {
  std::vector<ParameterInformation> more = count_parameters();
  more.push_back(heuristic_parameter());
  return {
      {{.name = "direct_light/multi_sample",
        .summary = "Light reflected towards a viewer, by multiple importance sampling.",
        .description =
            "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw by X = 1/n_l sum w_l f/p_l + "
            "1/n_b sum w_b f/p_b over n_l samples of the luminaire and n_b of the BRDF (Veach "
            "1997, eq. 9.4), as direct_light/light and direct_light/brdf draw them. Weights sum "
            "to 1 at every direction, so X is unbiased. With q = n p they are, by `heuristic`: "
            "balance q_i / sum q; power q_i^e / sum q^e; cutoff: 0 where q_i is below t times the "
            "larger, else as balance; maximum: 1 for the larger. By balance V[X] <= V[any other "
            "weights] + (1 / min n_i - 1 / sum n_i) L_r^2 (theorem 9.2). n_l shadow rays and n_b "
            "closest hits a primary, none below the horizon. Means are known as for "
            "direct_light/light, variances for balance and power. Samplers: light (of a polygon), "
            "brdf.",
        .parameters = parameters_with(std::move(more))},
       prepare}};
}

}  // namespace assay::plugins
