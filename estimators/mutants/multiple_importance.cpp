// Mutants of multiple importance sampling of light and BRDF: weights, densities or techniques with
// one thing wrong.
//
// I is the radiance, I_l and I_b its parts, the integrals of w_l f and w_b f. A defect that leaves
// the sum of weights at 1 leaves no bias, and shows in the variance alone. Unless said otherwise,
// figures are for the balance heuristic and a sample of each. The light is a square of side 0.6 at
// the distance 2 in the mirror direction. The reflectance is Ashikhmin-Shirley with exponents 1000
// and 100.

#include "direct_light/exact.h"
#include "estimators/mutant.h"

namespace assay::plugins {

namespace {

using namespace direct_light;

// Replacements for the weights. They hold the sound ones and what else they need.

struct Sound {
  WeightedByHeuristic combination;
  WeightedByHeuristic without_counts;
  double area_density;  ///< per area
  Pair probabilities;   ///< of the one-sample model

  double light(const Pair& p) const { return combination.light(p); }
  double brdf(const Pair& p) const { return combination.brdf(p); }
};

struct Unnormalised : Sound {
  double light(const Pair& p) const { return Sound::light(p) * Sound::light(p); }
  double brdf(const Pair& p) const { return Sound::brdf(p) * Sound::brdf(p); }
};

struct UnweightedBrdf : Sound {
  double brdf(const Pair&) const { return 1; }
};

struct ExchangedForBrdf : Sound {
  double brdf(const Pair& p) const { return Sound::light(p); }
};

struct Exchanged : ExchangedForBrdf {
  double light(const Pair& p) const { return Sound::brdf(p); }
};

struct AreaDensityForBrdf : Sound {
  double brdf(const Pair& p) const { return Sound::brdf({area_density, p.brdf}); }
};

struct AreaDensityInWeights : AreaDensityForBrdf {
  double light(const Pair& p) const { return Sound::light({area_density, p.brdf}); }
};

struct NoCountsForBrdf : Sound {
  double brdf(const Pair& p) const { return without_counts.brdf(p); }
};

struct NoCounts : NoCountsForBrdf {
  double light(const Pair& p) const { return without_counts.light(p); }
};

struct LightDensityForBrdf : Sound {
  double brdf(const Pair& p) const { return Sound::brdf(p) * p.brdf / p.light; }
};

struct NoSelection : Sound {
  double light(const Pair& p) const { return Sound::light(p) * probabilities.light; }
  double brdf(const Pair& p) const { return Sound::brdf(p) * probabilities.brdf; }
};

// Replacements for the techniques.

struct AreaDensity final : Techniques {
  using Techniques::Techniques;
  Draw light(Stream& random, Cost& cost) const override {
    Draw draw = Techniques::light(random, cost);
    draw.density.light = 1 / setting().area();
    return draw;
  }
};

struct BackSideSeen final : Techniques {
  using Techniques::Techniques;
  Draw brdf(Stream& random, Cost& cost) const override {
    const render::Vector3 w = reflectance().sample(random);
    if (w.z <= 0) return {};
    const auto* const triangle = setting().first_hit(setting().ray(w), cost);
    if (!triangle) return {};
    if (triangle->emits) return {integrand(w), density(*triangle, w)};
    return {integrand(w), {0, reflectance().density(w)}};
  }
};

struct MissesNotCounted {
  SharedTechniques techniques;
  Counts counts;
  Sound combination;

  double operator()(Stream& random, Cost& cost) const {
    double light = 0;
    for (std::uint64_t i = 0; i < counts.light; ++i) {
      light += from_light(combination, techniques->light(random, cost));
    }
    double brdf = 0;
    double hits = 0;
    for (std::uint64_t i = 0; i < counts.brdf; ++i) {
      const Draw draw = techniques->brdf(random, cost);
      brdf += from_brdf(combination, draw);
      hits += draw.integrand > 0 ? 1 : 0;
    }
    return light / static_cast<double>(counts.light) + (hits > 0 ? brdf / hits : 0);
  }
};

// Set-ups. The channel keeps the original's mean, the reference to be missed.

Sound sound(const Techniques& techniques, Heuristic heuristic, const Pair& shares) {
  return {.combination = WeightedByHeuristic(heuristic, shares),
          .without_counts = WeightedByHeuristic(heuristic, {1, 1}),
          .area_density = 1 / techniques.setting().area(),
          .probabilities = shares};
}

/// Primary<Combination> of the multi-sample model with `OfTechniques`.
template <class Combination, class OfTechniques = Techniques,
          class Primary = MultiSamplePrimary<Combination>>
std::shared_ptr<const Setup> multi_sample(Parameters& given) {
  const auto of = read_techniques<OfTechniques>(given);
  const Counts counts = read_counts(given);
  const Combination combination{sound(*of, read_heuristic(given), counts.shares())};
  return averaging(mean_channel(radiance(*of)), Primary{of, counts, combination});
}

template <class Combination>
std::shared_ptr<const Setup> one_sample(Parameters& given) {
  const auto of = read_techniques(given);
  const Pair probabilities = read_probabilities(given);
  const Combination combination{sound(*of, read_heuristic(given), probabilities)};
  return averaging(mean_channel(radiance(*of)),
                   OneSamplePrimary<Combination>{of, probabilities, combination});
}

}  // namespace

std::vector<Entry> mutants_multiple_importance() {
  return {
      mutant({"weights_squared", "direct_light/multi_sample",
              "squares the weights, which then do not sum to 1: minus twice the integral "
              "of w_l w_b f, -46.9 %."},
             multi_sample<Unnormalised>),
      mutant({"brdf_unweighted", "direct_light/multi_sample",
              "takes samples of the BRDF that hit the light with the weight 1, so that "
              "what both techniques find counts twice: I_l too much, +52.4 %."},
             multi_sample<UnweightedBrdf>),
      mutant({"brdf_weight_of_light", "direct_light/multi_sample",
              "gives samples of the BRDF the weight of the light: I_l - I_b, +4.7 %; -80 "
              "% where the BRDF is much the better technique."},
             multi_sample<ExchangedForBrdf>),
      mutant({"weights_exchanged", "direct_light/multi_sample",
              "gives each technique the weight of the other: they sum to 1, no bias, but "
              "each technique counts where it is the worse one: 1.7 times the variance, "
              "190 times under the large light of `suites/direct-light.yaml`."},
             multi_sample<Exchanged>),
      mutant({"brdf_weight_by_area", "direct_light/multi_sample",
              "weighs samples of the BRDF against the density of light samples per area "
              "instead of per solid angle, without cos / r^2: +29.5 %, and another bias "
              "in another unit of length."},
             multi_sample<AreaDensityForBrdf>),
      mutant({"weights_by_area", "direct_light/multi_sample",
              "takes the light's density per area in the weights of both techniques: they "
              "sum to 1, no bias, but the variance depends on the unit of length: 13 "
              "times as much on the rough surface of `suites/direct-light.yaml`."},
             multi_sample<AreaDensityInWeights>),
      mutant({"light_density_by_area", "direct_light/multi_sample",
              "takes the density of light samples per area for that per solid angle, in "
              "the weight and in the quotient: +41.1 %."},
             multi_sample<Sound, AreaDensity>),
      mutant({"brdf_divided_by_light_density", "direct_light/multi_sample",
              "divides samples of the BRDF by the density of the light's samples: I_l + "
              "the integral of w_b f p_b / p_l, +4.6 %."},
             multi_sample<LightDensityForBrdf>),
      mutant(
          {"brdf_weight_without_counts", "direct_light/multi_sample",
           "leaves the numbers of samples out of the weights of the BRDF: -24.0 % with one sample "
           "of the light and three of the BRDF, nothing where the numbers are equal."},
          multi_sample<NoCountsForBrdf>),
      mutant({"weights_without_counts", "direct_light/multi_sample",
              "leaves the numbers of samples out of all weights: they sum to 1, no bias, "
              "but more variance where the numbers differ: 5.2 times under the large "
              "light of `suites/direct-light.yaml` with one and three."},
             multi_sample<NoCounts>),
      mutant({"light_from_behind", "direct_light/multi_sample",
              "lets rays of the BRDF see the back of the light: a light that faces away "
              "shines, nothing where the front is seen."},
             multi_sample<Sound, BackSideSeen>),
      mutant({"misses_not_counted", "direct_light/multi_sample",
              "averages samples of the BRDF over those that hit the light: +31.3 % with "
              "four of them, nothing with one."},
             multi_sample<Sound, Techniques, MissesNotCounted>),
      mutant({"no_selection_probability", "direct_light/one_sample",
              "does not divide by the probability of the technique: -50 % where that is "
              "0.5, (c_l - 1) I_l + (c_b - 1) I_b."},
             one_sample<NoSelection>),
  };
}

}  // namespace assay::plugins
