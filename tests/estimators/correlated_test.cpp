
#include "correlated/area_pairs.h"
#include "correlated/estimators.h"
#include "tests/estimators/draws.h"
#include "tests/estimators/scenes.h"
#include "tests/prelude.h"

namespace assay {
namespace {

using correlated::Centre;
using correlated::Sums;
using namespace assay::draws;

std::string hidden_beyond(double t, const std::string& more = "") {
  return "{scene: " + tests::hidden_beyond(t) + more + "}";
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
