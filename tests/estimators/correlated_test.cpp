#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numbers>

#include "correlated/area_pairs.h"
#include "correlated/estimators.h"
#include "tests/estimators/draws.h"

namespace assay {
namespace {

using correlated::Centre;
using correlated::Sums;
using namespace assay::draws;

/// The built-in rectangle, hidden where x > t by a screen half-way up.
std::string hidden_beyond(double t, const std::string& more = "") {
  const std::string edge = std::to_string(t / 2);
  return "{scene: {receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[-.8, "
         "-.6, "
         "1], [.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}, occluders: [{polygon: [[" +
         edge + ", -9, .5], [9, -9, .5], [9, 9, .5], [" + edge + ", 9, .5]]}]}" + more + "}";
}

double exact_sd(double t, double lambda) {
  const auto plugin =
      prepare("correlated/area", hidden_beyond(t, ", lambda: " + std::to_string(lambda)));
  return std::sqrt(plugin.setup->channels()[0].variance.value());
}

// By an independent simulation of the same pairs in numpy, 2e6 samples: three digits.
TEST(Correlated, ExactVariancesOfImportanceCorrelatedAndBest) {
  EXPECT_NEAR(exact_sd(.5, 0), .738, 1e-3);
  EXPECT_NEAR(exact_sd(.5, 1), .398, 1e-3);
  EXPECT_NEAR(exact_sd(.5, 1.3212), .366, 1e-3);
  EXPECT_NEAR(exact_sd(.05, 0), .773, 1e-3);
  EXPECT_NEAR(exact_sd(.05, 1), .712, 1e-3);
  EXPECT_NEAR(exact_sd(.05, .691), .6965, 1e-3);
  EXPECT_NEAR(exact_sd(-.5, 0), .3815, 1e-3);
  EXPECT_NEAR(exact_sd(-.5, 1), .695, 1e-3);
  EXPECT_NEAR(exact_sd(-.5, -.216), .367, 1e-3);
}

TEST(Correlated, TheBestLambdaLiesOutsideTheUnitInterval) {
  const auto best = [](double t) {
    return *prepare("correlated/area_same_samples", hidden_beyond(t)).setup->channels()[1].mean;
  };
  EXPECT_NEAR(best(.5), 1.3212, 2e-3);
  EXPECT_NEAR(best(.05), .6909, 2e-3);
  EXPECT_NEAR(best(-.5), -.2158, 2e-3);
  // It is where the variance is least.
  EXPECT_LT(exact_sd(.5, best(.5)), exact_sd(.5, best(.5) + .01));
  EXPECT_LT(exact_sd(.5, best(.5)), exact_sd(.5, best(.5) - .01));
}

// False alarm: 9 comparisons of means and of variances at 1e-6 each.
TEST(Correlated, SampledMeansAndVariancesAreExact) {
  for (const double t : {.5, .05, -.5}) {
    for (const char* lambda : {"0", "1", "-0.7"}) {
      const auto plugin =
          prepare("correlated/area", hidden_beyond(t, std::string(", lambda: ") + lambda));
      const Channel channel = plugin.setup->channels()[0];
      const Sample sample = observe(plugin, 200000)[0];
      EXPECT_NEAR(sample.mean(), *channel.mean, five * sample.mean_error()) << t << lambda;
      EXPECT_NEAR(sample.variance(), *channel.variance, five * sample.variance_error())
          << t << lambda;
    }
  }
}

TEST(Correlated, WhereNothingIsHiddenTheEstimateIsTheIntegral) {
  const auto plugin = prepare("correlated/area", "{scene: rectangle, lambda: 1}");
  const auto least_squares =
      prepare("correlated/area_same_samples", "{scene: rectangle, centre: mean}");
  const Sample correlated = observe(plugin, 100)[0];
  const Sample fitted = observe(least_squares, 100, 16)[0];
  for (const double x : correlated.values) EXPECT_NEAR(x, 1.320523614, 1e-9);
  for (const double x : fitted.values) EXPECT_NEAR(x, 1.320523614, 1e-9);
}

TEST(Correlated, ThePublishedLambdaIsNotOneWhereNothingIsHidden) {
  // With d = 1, 3, J = 5 and f = J - d: sum d (mean f - f) = 2, sum d^2 = 10. About the mean it is
  // 2.
  Sums sums;
  sums.add(4, 1);
  sums.add(2, 3);
  EXPECT_DOUBLE_EQ(correlated::estimated_lambda(Centre::integral)(sums, 5), .2);
  EXPECT_DOUBLE_EQ(correlated::estimated_lambda(Centre::mean)(sums, 5), 1);
}

TEST(Correlated, LambdaIsClampedOnlyWhereAsked) {
  Sums sums;  // f falls where g rises
  sums.add(1, -1);
  sums.add(0, 1);
  EXPECT_DOUBLE_EQ(correlated::estimated_lambda(Centre::integral)(sums, 5), .5);
  sums.add(9, 2);
  EXPECT_LT(correlated::estimated_lambda(Centre::integral)(sums, 5), 0);
  EXPECT_EQ(correlated::clamped_lambda(Centre::integral)(sums, 5), 0);
}

TEST(Correlated, AControlWithoutSpreadCorrectsNothing) {
  Sums sums;
  sums.add(1, 1e-14);
  sums.add(3, -1e-14);
  EXPECT_EQ(correlated::estimated_lambda(Centre::integral)(sums, 5), 0);
  EXPECT_EQ(correlated::estimated_lambda(Centre::mean)(sums, 5), 0);
}

TEST(Correlated, FewerThanTwoSamplesGiveImportanceSampling) {
  const auto importance = prepare("correlated/area", hidden_beyond(.5, ", lambda: 0"));
  for (const char* name : {"same_samples", "cross_fitted"}) {
    auto plugin = prepare(std::string("correlated/area_") + name, hidden_beyond(.5));
    plugin.key = importance.key;
    EXPECT_EQ(observe(plugin, 20)[0].values, observe(importance, 20)[0].values) << name;
  }
}

// False alarm 1e-6 each. The bias of the same samples is that of the numpy simulation.
TEST(Correlated, CrossFittingIsUnbiasedAndTheSameSamplesAreNot) {
  const auto same = prepare("correlated/area_same_samples", hidden_beyond(-.5));
  const auto crossed = prepare("correlated/area_cross_fitted", hidden_beyond(-.5));
  const double exact = *same.setup->channels()[0].mean;
  const Sample biased = observe(same, 200000, 4)[0];
  const Sample sound = observe(crossed, 200000, 4)[0];
  EXPECT_NEAR(biased.mean() / exact, 1.0457, five * (biased.mean_error() / exact + .0012));
  EXPECT_GT(biased.mean() - exact, five * biased.mean_error());
  EXPECT_NEAR(sound.mean(), exact, five * sound.mean_error());
}

TEST(Correlated, AMeshIsRefusedBecauseItsIntegralIsUnknown) {
  const std::string file = testing::TempDir() + "correlated_mesh.obj";
  std::ofstream(file) << "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 3 2\n";
  try {
    prepare("correlated/area",
            "{scene: {receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {obj: " + file +
                ", radiance: 1}}}");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(std::string(error.what()), testing::HasSubstr("scene")) << error.what();
  }
}

const std::string data = ASSAY_SOURCE_DIR "/suites/data";

// False alarm 1e-6 each.
TEST(Correlated, SkiesAreUnbiasedHoweverTheyAreSampled) {
  for (const char* sampling : {"uniform", "cosine", "emittance", "steered"}) {
    for (const char* lambda : {"0", "1"}) {
      const auto plugin = prepare(
          "correlated/sky",
          std::string("{sky: {map: sky.exr}, sampling: ") + sampling + ", lambda: " + lambda + "}",
          data);
      const auto channels = plugin.setup->channels();
      const auto samples = observe(plugin, 50000);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(samples[c].mean(), *channels[c].mean, five * samples[c].mean_error())
            << sampling << lambda;
      }
    }
  }
}

TEST(Correlated, UnderAUniformSkyTheControlIsAll) {
  const auto plugin = prepare("correlated/sky", "{sky: {uniform: 3}, sampling: uniform}");
  const Sample sample = observe(plugin, 50)[0];
  for (const double x : sample.values) EXPECT_NEAR(x, 3 * std::numbers::pi, 1e-13);
}

TEST(Correlated, ByTheCosineTheControlCorrectsNothing) {
  const std::string sky = "{sky: {gradient: {base: 1, slope: [.5, 0, .3]}}, sampling: cosine";
  const Sample without = observe(prepare("correlated/sky", sky + ", lambda: 0}"), 100)[0];
  auto other = prepare("correlated/sky", sky + ", lambda: 1}");
  other.key = prepare("correlated/sky", sky + ", lambda: 0}").key;
  const Sample with = observe(other, 100)[0];
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(with.values[i], without.values[i], 1e-13);
  const Sample lambda = observe(prepare("correlated/sky_same_samples", sky + "}"), 100, 16)[1];
  for (const double x : lambda.values) EXPECT_EQ(x, 0);
}

TEST(Correlated, ABlackSkyIsRefusedWhereItIsSampledBy) {
  EXPECT_THROW(prepare("correlated/sky", "{sky: {uniform: 0}, sampling: emittance}"), InputError);
  EXPECT_NO_THROW(prepare("correlated/sky", "{sky: {uniform: 0}, sampling: cosine}"));
}

struct Bias {
  const char* mutant;
  std::string parameters;
  double expected;  // of the irradiance, absolutely
};

// False alarm 1e-6 each.
TEST(Correlated, MutantsAreBiasedAsExpected) {
  const double j = 1.320523614;
  const double i = .17087090832672724;
  const std::string horizon =
      "{scene: {receiver: {position: [0, 0, 0], normal: [.9, 0, .3]}, light: {polygon: [[-.8, -.6, "
      "1], [.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}}, lambda: .5}";
  const std::string bright =
      "{scene: {receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[-.8, -.6, "
      "1], [.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 2}}, lambda: .5}";
  const std::vector<Bias> table = {
      {"mutants/control_added_twice", hidden_beyond(-.5), 2 * j},
      {"mutants/control_without_pi", hidden_beyond(-.5), j * (1 / std::numbers::pi - 1)},
      {"mutants/control_visible", hidden_beyond(-.5, ", lambda: .5"), .5 * (j - i)},
      {"mutants/control_elsewhere", hidden_beyond(-.5), 0},
      {"mutants/control_unclipped", horizon, .5 * (.44965 - .5091770)},
      {"mutants/control_without_radiance", bright, .5 * (j - 2 * j)}};
  for (const auto& [name, parameters, expected] : table) {
    const auto mutant = prepare(name, parameters);
    const Sample sample = observe(mutant, 100000)[0];
    EXPECT_NEAR(sample.mean() - *mutant.setup->channels()[0].mean, expected,
                five * sample.mean_error() + 5e-6)
        << name;
  }
}

TEST(Correlated, MutantsOfLambdaSpoilItsLimitOrItsIndependence) {
  const auto sound = prepare("correlated/area_cross_fitted", hidden_beyond(-.5));
  const auto uncentred = prepare("mutants/lambda_uncentred", hidden_beyond(-.5));
  const auto pooled = prepare("mutants/lambda_pooled", hidden_beyond(-.5));
  const double exact = *sound.setup->channels()[0].mean;
  const double best = *sound.setup->channels()[1].mean;
  // (Cov + I J) / Var g, Var g = Cov / lambda* over all.
  const Sample lambda = observe(uncentred, 2000, 400)[1];
  EXPECT_GT(lambda.mean(), best + .8);
  EXPECT_EQ(observe(prepare("mutants/lambda_own_half", hidden_beyond(-.5)), 50, 8)[0].values, [&] {
    auto same = prepare("correlated/area_same_samples", hidden_beyond(-.5));
    same.key = sound.key;
    return observe(same, 50, 8)[0].values;
  }());
  const Sample sample = observe(pooled, 200000, 4)[0];
  EXPECT_GT(sample.mean() - exact, five * sample.mean_error());
}

}  // namespace
}  // namespace assay
