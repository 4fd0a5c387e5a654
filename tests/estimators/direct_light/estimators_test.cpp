// Direct lighting against closed forms, quadrature from elsewhere and theorems.

#include "tests/estimators/prelude.h"
#include "tests/estimators/scenes.h"

namespace assay {
namespace {

using direct_light_scenes::large;
using direct_light_scenes::parameters;
using direct_light_scenes::scene;
using direct_light_scenes::small;

Channel stated(const std::string& plugin, const std::string& given) {
  return channel("direct_light/" + plugin, given);
}

/// A square that emits away from the receiver.
const std::string away = "{scene: {" + direct_light_scenes::receiver +
                         ", light: {polygon: " + small +
                         ", normal: [0.7173561, 0, 0.6967067], radiance: 1}}";

struct Strategy {
  const char* plugin;
  const char* more;
};

// In the order of the table's columns, from `light` on.
const std::vector<Strategy> tabulated{
    {"light", ""},        {"light", "light_sampling: area"},    {"brdf", ""},
    {"multi_sample", ""}, {"multi_sample", "heuristic: power"}, {"multi_sample", "brdf_samples: 3"},
    {"one_sample", ""},   {"one_sample", "heuristic: power"}};

// The table is by the midpoint rule with 2000^2 nodes, good to 1e-7.
TEST(DirectLight, MeansAndVariancesAgreeWithTheTable) {
  int variances = 0;
  for (const auto& row : tests::table("direct_light.csv")) {
    for (std::size_t i = 0; i < tabulated.size(); ++i) {
      const auto& [plugin, more] = tabulated[i];
      SCOPED_TRACE(row[0] + row[1] + plugin + more);
      const Channel known = stated(plugin, parameters(row[0], row[1], more));
      const double mean = std::stod(row[2]);
      EXPECT_NEAR(*known.mean, mean, 1e-6 * mean);
      EXPECT_LT(known.mean_error, 1e-8 * mean);
      if (!known.variance) continue;
      ++variances;
      const double variance = std::stod(row[4 + i]);
      EXPECT_NEAR(*known.variance, variance, 1e-6 * variance);
    }
  }
  EXPECT_EQ(variances, 24);
}

// The table is of light from everywhere and good to 1e-8 and six digits. Beyond a border at 500 the
// lobe of roughness 0.3 has about 3e-5 of its light (below 0.004 above the horizon), the others
// none.
TEST(DirectLight, TheLobeIsFoundUnderACeilingOfAnySize) {
  for (const auto& row : tests::table("direct_light_ceiling.csv")) {
    for (const char* size : {"500", "2000", "30000"}) {
      SCOPED_TRACE(row[0] + " " + size);
      const std::string r = size;
      const std::string square = "[[-" + r + ", -" + r + ", 2], [-" + r + ", " + r + ", 2], [" + r +
                                 ", " + r + ", 2], [" + r + ", -" + r + ", 2]]";
      const std::string given = "{" + direct_light_scenes::scene(square) +
                                ", brdf: {ward: {alpha_x: " + row[0] + ", alpha_y: " + row[0] +
                                ", theta_i: 0.8, phi_i: 3.1416}}}";
      const Channel known = stated("brdf", given);
      const double mean = std::stod(row[1]);
      const double beyond = row[0] == "0.3" ? 3e-5 * mean : 0;
      EXPECT_NEAR(known.mean.value(), mean, 1e-7 * mean + beyond);
      EXPECT_LT(known.mean_error, 1e-8 * mean);
      const double variance = std::stod(row[2]);
      EXPECT_NEAR(known.variance.value(), variance, 1e-5 * variance + 2 * mean * beyond);
    }
  }
}

TEST(DirectLight, WhereALobeCannotBeLookedForEverywhereNoMeanIsStated) {
  const auto has_mean = [](const char* plugin, const char* exponent) {
    const std::string square = "[[-1e6, -1e6, 1], [-1e6, 1e6, 1], [1e6, 1e6, 1], [1e6, -1e6, 1]]";
    return stated(plugin, "{" + direct_light_scenes::scene(square) +
                              ", brdf: {ashikhmin_shirley: {nu: " + exponent + "}}}")
        .mean.has_value();
  };
  EXPECT_TRUE(has_mean("brdf", "100"));
  for (const char* plugin : {"light", "brdf", "multi_sample", "one_sample"}) {
    EXPECT_FALSE(has_mean(plugin, "10000")) << plugin;
  }
}

TEST(DirectLight, ADiffuseSurfaceReflectsLambertsFormula) {
  const Channel known = stated("light", "{scene: triangle, brdf: {lambert: {albedo: 0.5}}}");
  EXPECT_NEAR(*known.mean, .5 / pi * .4810469073159319, 1e-15);
  // The cosine cancels in f cos / p: Bernoulli of value albedo.
  const Channel by_brdf = stated("brdf", "{scene: triangle, brdf: {lambert: {albedo: 0.5}}}");
  EXPECT_NEAR(*by_brdf.variance, *known.mean * (.5 - *known.mean), 1e-10);
}

TEST(DirectLight, WhatTwoScreensHideIsHiddenByOneWhole) {
  const auto screened = [](const std::string& screens) {
    return stated("light", "{" + scene(small, ", occluders: [" + screens + "]") +
                               direct_light_scenes::brdf("glossy") + "}");
  };
  const std::string above = "{polygon: [[.5, 0, .1], [.5, 3, .1], [.5, 3, 3], [.5, 0, 3]]}";
  const std::string below = "{polygon: [[.5, -3, .1], [.5, 0, .1], [.5, 0, 3], [.5, -3, 3]]}";
  const double whole = *stated("light", parameters("small", "glossy")).mean;
  EXPECT_NEAR(*screened(above).mean + *screened(below).mean, whole, 1e-9 * whole);
  const Channel hidden = screened(above + ", " + below);
  EXPECT_NEAR(*hidden.mean, 0, hidden.mean_error);
  EXPECT_LT(hidden.mean_error, 1e-9 * whole);
}

// Theorem 9.2 of Veach (1997), for heuristics and either technique alone as other weights.
TEST(DirectLight, TheBalanceHeuristicIsWithinItsBound) {
  for (const auto& [square, surface] :
       {std::array{"large", "smooth"}, {"small", "glossy"}, {"small", "rough"}}) {
    const Channel light = stated("light", parameters(square, surface));
    const Channel brdf = stated("brdf", parameters(square, surface));
    for (const auto& [n_l, n_b] : {std::array{1, 1}, {1, 3}, {3, 1}, {4, 2}}) {
      const std::string counts =
          "light_samples: " + std::to_string(n_l) + ", brdf_samples: " + std::to_string(n_b);
      const Channel balance = stated("multi_sample", parameters(square, surface, counts));
      const Channel power =
          stated("multi_sample", parameters(square, surface, counts + ", heuristic: power"));
      const double mean = *balance.mean;
      const double bound = (1.0 / std::min(n_l, n_b) - 1.0 / (n_l + n_b)) * mean * mean;
      for (const double other :
           {*light.variance / n_l, *brdf.variance / n_b, power.variance.value()}) {
        EXPECT_LE(*balance.variance, other + bound) << square << surface << counts;
      }
    }
  }
}

// Section 9.2.4: as importance sampling of the mixture.
TEST(DirectLight, InTheOneSampleModelTheBalanceHeuristicIsBest) {
  for (const auto& [surface, probability] :
       {std::array{"rough", "0.2"}, {"rough", "0.9"}, {"glossy", "0.5"}}) {
    const std::string c = std::string("light_probability: ") + probability;
    const double balance = *stated("one_sample", parameters("small", surface, c)).variance;
    for (const char* other : {"power", "{power: 1.2}", "{power: 5}"}) {
      const std::string more = c + ", heuristic: " + other;
      EXPECT_LT(balance, *stated("one_sample", parameters("small", surface, more)).variance);
    }
  }
  // Light sampling alone is a limit of it.
  const double light = *stated("light", parameters("small", "rough")).variance;
  const std::string nearly = parameters("small", "rough", "light_probability: 0.9999999");
  EXPECT_NEAR(*stated("one_sample", nearly).variance, light, 1e-3 * light);
}

TEST(DirectLight, DensitiesOfDrawsAreThoseOfTheirDirections) {
  for (const auto& [plugin, sampler, more] :
       {std::array{"light", "light", ""},
        {"light", "light", "light_sampling: area"},
        {"one_sample", "mixture", "light_sampling: area, light_probability: 0.3"},
        {"multi_sample", "brdf", ""}}) {
    const auto prepared =
        prepare(std::string("direct_light/") + plugin, parameters("large", "rough", more));
    const auto named = prepared.sampler(sampler);
    int valid = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      Stream random(prepared.key, i);
      const SamplerDraw draw = named->sample(random);
      if (!draw.valid) continue;
      ++valid;
      const double density = named->density(draw.point);
      EXPECT_NEAR(draw.density, density, 1e-9 * density) << plugin << sampler;
      EXPECT_NEAR(draw.weight * density, named->evaluate(draw.point), 1e-9 * density);
    }
    EXPECT_GT(valid, 1000);
  }
}

TEST(DirectLight, LobesOfTheMixtureMakeItsDensity) {
  const auto prepared =
      prepare("direct_light/one_sample", parameters("small", "glossy", "light_probability: 0.25"));
  const auto mixture = prepared.sampler();
  const auto light = prepare("direct_light/light", parameters("small", "glossy")).sampler();
  const Point inside{1.4347 / 2, 0, 1.3934 / 2};
  EXPECT_EQ(mixture->lobes(), 2);
  EXPECT_NEAR(mixture->lobe_density(0, inside), .25 * light->density(inside), 1e-12);
  EXPECT_NEAR(mixture->density(inside),
              mixture->lobe_density(0, inside) + mixture->lobe_density(1, inside), 1e-12);
  EXPECT_EQ(mixture->lobe_density(0, {0, 0, 1}), 0);
}

// False-alarm rate 1e-6 each. The albedos are those of brdf_test.cpp.
TEST(DirectLight, UnderLightFromEverywhereASurfaceReflectsItsAlbedo) {
  const std::string dome =
      "scene: {" + direct_light_scenes::receiver + ", light: {obj: dome.obj, radiance: 1}}";
  for (const auto& [brdf, albedo] :
       {std::pair{", brdf: {ward: {alpha_x: 0.15, alpha_y: 0.4}}", .564185},
        {", brdf: {ashikhmin_shirley: {}}", .373217}}) {
    for (const char* more : {"", ", light_sampling: area", ", heuristic: {power: 3}"}) {
      const auto prepared = prepare("direct_light/multi_sample", "{" + dome + brdf + more + "}");
      EXPECT_FALSE(prepared.channel().mean.has_value());
      EXPECT_THAT(observe(prepared, 50000)[0], HasMean(albedo, 1e-6)) << brdf << more;
    }
  }
}

TEST(DirectLight, FromBehindALightIsDark) {
  for (const char* plugin : {"light", "brdf", "multi_sample", "one_sample"}) {
    const auto prepared = prepare(std::string("direct_light/") + plugin, away + "}");
    EXPECT_EQ(prepared.channel().mean, 0);
    EXPECT_THAT(observe(prepared, 200)[0].values, Each(0));
  }
}

// The BRDF's samples see what the front would show.
TEST(DirectLightMutants, TheBackOfALightShines) {
  const auto mutant =
      prepare("mutants/light_from_behind", away + direct_light_scenes::brdf("glossy") + "}");
  EXPECT_EQ(mutant.channel().mean, 0);
  EXPECT_THAT(observe(mutant, 20000)[0], HasMean(.343091));
}

// The range and the variance are the original's alone.
TEST(DirectLightMutants, ClaimTheOriginalsMeanAndNoMore) {
  const auto mutant = prepare("mutants/weights_squared", parameters("small", "glossy"));
  const auto original = prepare("direct_light/multi_sample", parameters("small", "glossy"));
  EXPECT_NEAR(*mutant.channel().mean, *original.channel().mean, 1e-9);
  EXPECT_FALSE(mutant.channel().variance.has_value());
  EXPECT_EQ(mutant.key, original.key);
}

}  // namespace
}  // namespace assay
