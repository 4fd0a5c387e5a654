#include "correlated/estimators.h"
#include "tests/estimators/prelude.h"
#include "tests/estimators/scenes.h"

namespace assay {
namespace {

using correlated::Centre;
using correlated::Sums;

std::string hidden_beyond(double t, const std::string& more = "") {
  return "{scene: " + tests::hidden_beyond(t) + more + "}";
}

Prepared area(double t, const std::string& name = "area_same_samples") {
  return prepare("correlated/" + name, hidden_beyond(t));
}

double exact_sd(double t, double lambda) {
  const std::string more = ", lambda: " + std::to_string(lambda);
  return std::sqrt(channel("correlated/area", hidden_beyond(t, more)).variance.value());
}

// By an independent simulation of the same pairs in numpy, 2e6 samples: three digits. The best
// lambda lies outside the unit interval.
TEST(Correlated, ExactVariancesOfImportanceCorrelatedAndBest) {
  for (const auto& [t, importance, correlated, lambda, best] :
       {std::array{.5, .738, .398, 1.3212, .366},
        {.05, .773, .712, .6909, .6965},
        {-.5, .3815, .695, -.2158, .367}}) {
    EXPECT_NEAR(exact_sd(t, 0), importance, 1e-3);
    EXPECT_NEAR(exact_sd(t, 1), correlated, 1e-3);
    EXPECT_NEAR(exact_sd(t, lambda), best, 1e-3);
    const double found = *area(t).channel(1).mean;
    EXPECT_NEAR(found, lambda, 2e-3);
    EXPECT_LT(exact_sd(t, found), exact_sd(t, found + .01));
    EXPECT_LT(exact_sd(t, found), exact_sd(t, found - .01));
  }
}

TEST(Correlated, WhereNothingIsHiddenTheEstimateIsTheIntegral) {
  const auto plugin = prepare("correlated/area", "{scene: rectangle, lambda: 1}");
  const auto least_squares =
      prepare("correlated/area_same_samples", "{scene: rectangle, centre: mean}");
  const auto is_exact = Each(DoubleNear(1.320523614, 1e-9));
  EXPECT_THAT(observe(plugin, 100)[0].values, is_exact);
  EXPECT_THAT(observe(least_squares, 100, 16)[0].values, is_exact);
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
  for (const char* name : {"area_same_samples", "area_cross_fitted"}) {
    EXPECT_EQ(values_by(importance.key, area(.5, name), 20), observe(importance, 20)[0].values);
  }
}

// False alarm 1e-6 each. The bias of the same samples is that of the numpy simulation.
TEST(Correlated, CrossFittingIsUnbiasedAndTheSameSamplesAreNot) {
  const double exact = *area(-.5).channel().mean;
  const Sample biased = observe(area(-.5), 200000, 4)[0];
  EXPECT_THAT(biased, HasMean(1.0457 * exact, five * .0012 * exact));
  EXPECT_GT(biased.mean() - exact, five * biased.mean_error());
  EXPECT_THAT(observe(area(-.5, "area_cross_fitted"), 200000, 4)[0], HasMean(exact));
}

TEST(Correlated, UnderAUniformSkyTheControlIsAll) {
  const auto plugin = prepare("correlated/sky", "{sky: {uniform: 3}, sampling: uniform}");
  EXPECT_THAT(observe(plugin, 50)[0].values, Each(DoubleNear(3 * std::numbers::pi, 1e-13)));
}

TEST(Correlated, ByTheCosineTheControlCorrectsNothing) {
  const std::string sky = "{sky: {gradient: {base: 1, slope: [.5, 0, .3]}}, sampling: cosine";
  const Prepared without = prepare("correlated/sky", sky + ", lambda: 0}");
  const auto with = values_by(without.key, prepare("correlated/sky", sky + ", lambda: 1}"), 100);
  EXPECT_THAT(with, Pointwise(DoubleNear(1e-13), observe(without, 100)[0].values));
  EXPECT_THAT(observe(prepare("correlated/sky_same_samples", sky + "}"), 100, 16)[1].values,
              Each(0));
}

TEST(Correlated, MutantsOfLambdaSpoilItsLimitOrItsIndependence) {
  const Prepared sound = area(-.5, "area_cross_fitted");
  const auto mutant = [](const char* name) { return prepare(name, hidden_beyond(-.5)); };
  // (Cov + I J) / Var g, Var g = Cov / lambda* over all.
  const Sample lambda = observe(mutant("mutants/lambda_uncentred"), 2000, 400)[1];
  EXPECT_GT(lambda.mean(), *sound.channel(1).mean + .8);
  EXPECT_EQ(observe(mutant("mutants/lambda_own_half"), 50, 8)[0].values,
            values_by(sound.key, area(-.5), 50, 8));
  const Sample sample = observe(mutant("mutants/lambda_pooled"), 200000, 4)[0];
  EXPECT_GT(sample.mean() - *sound.channel().mean, five * sample.mean_error());
}

}  // namespace
}  // namespace assay
