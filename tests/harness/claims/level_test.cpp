// False alarms: p-values of single true claims, from YAML to the record. Each p-value is valid at
// .1, .01 and .001, and uniform if its method is exact. A sound engine is called wrong with
// probability 1.3e-5 for each claim. The seeds are 1, 2, 3, ….

#include <fmt/format.h>

#include "tests/harness/known_effects.h"
#include "tests/harness/many_seeds.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

struct TrueClaim {
  std::string test;  ///< as in a suite, without braces
  Shape shape = Shape::uniform;
};

const std::map<std::string, std::string> estimators = with_known_effects({
    {"darts", "plugin: analytic/dart_throwing, primaries: 1"},
    {"normal", "plugin: analytic/normal, mean: 2, primaries: 1"},
    {"again", "plugin: analytic/normal, mean: 2, primaries: 1"},
    {"noisy", "plugin: analytic/normal, mean: 2, deviation: 300, primaries: 1"},
    {"wide", "plugin: analytic/normal, mean: 4, deviation: 3, primaries: 1"},
    {"negative", "plugin: analytic/normal, mean: -4, deviation: 3, primaries: 1"},
    {"pareto", "plugin: analytic/heavy_tail, index: 12, primaries: 4"},
    {"uniform", "plugin: analytic/exponential_uniform, primaries: 16"},
    {"hits", "plugin: luminaire/hemisphere, scene: triangle"},
    {"hits_again", "plugin: luminaire/hemisphere, scene: triangle"},
    {"ward", "plugin: brdf/ward"},
    {"ward_again", "plugin: brdf/ward"},
    {"narrow", "plugin: brdf/ward, alpha_x: 0.02, alpha_y: 0.03"},
    {"importance", "plugin: analytic/exponential_importance, primaries: 16"},
});

std::string suite_of(const std::vector<TrueClaim>& claims) {
  std::string tests;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    tests += fmt::format("  - {{name: '{}', {}}}\n", i, claims[i].test);
  }
  return "suite: level\nalpha: 0.1\nbeta: 0.1\n" + estimators_of(estimators, tests) + "tests:\n" +
         tests;
}

/// Levels of tests of one look.
void expect_level(std::uint64_t seeds, const std::vector<TrueClaim>& claims) {
  const std::string text = suite_of(claims);
  const auto outcomes = first_looks(tests::repetitions(seeds), text);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    expect_p_value(claims[i].test, outcomes.at(std::to_string(i)).log_p, claims[i].shape);
  }
  expect_as_in_runs(text);
}

/// Levels of tests in looks, over whole runs.
void expect_level_in_looks(std::uint64_t runs, const TrueClaim& claim) {
  const auto outcomes =
      over_seeds(tests::repetitions(runs), [&](std::uint64_t) { return suite_of({claim}); });
  expect_p_value(claim.test, outcomes.at("0").log_p, Shape::at_most_uniform);
}

TEST(Level, OfMeansAgainstNumbersIsWhatTheirPValuesSay) {
  expect_level(
      1000, {{"claim: mean(normal) == 2, secondaries: 20"},
             {"claim: mean(normal) <= 2, secondaries: 20"},
             {"claim: mean(normal) >= 2, secondaries: 20"},
             {"claim: mean(normal) < 2, secondaries: 20"},
             {"claim: mean(negative) <= -5, allow: 20%, secondaries: 20"},
             {"claim: mean(negative) == -5, allow: 20%, secondaries: 20", Shape::at_most_uniform},
             {"claim: mean(normal) within 0.2 of 1.8, secondaries: 20", Shape::at_most_uniform}});
}

TEST(Level, OfTwoMeansIsWhatTheirPValuesSay) {
  expect_level(2000, {{"claim: mean(normal) == mean(again), secondaries: 20"},
                      {"claim: mean(normal) == 0.5 * mean(wide), secondaries: 200"},
                      {"claim: mean(normal) <= 0.5 * mean(wide), secondaries: 200"},
                      {"claim: mean(normal) <= 0.4 * mean(wide), allow: 25%, secondaries: 400",
                       Shape::at_most_uniform},
                      {"claim: mean(normal) == -0.4 * mean(negative), allow: 25%, secondaries: 400",
                       Shape::at_most_uniform},
                      {"claim: mean(uniform) == mean(importance), secondaries: 100"}});
}

TEST(Level, OfVariancesIsWhatTheirPValuesSay) {
  expect_level(1000, {{"claim: variance(normal) == analytic, secondaries: 200"},
                      {"claim: variance(normal) <= 0.8, allow: 25%, secondaries: 200"},
                      {"claim: variance(normal) == variance(again), secondaries: 200"},
                      {"claim: variance(wide) <= 9 * variance(normal), secondaries: 200"},
                      {"claim: variance(normal) == 0.8, allow: 25%, secondaries: 200",
                       Shape::at_most_uniform}});
}

// Secondaries of excess kurtosis 3, where the method is the logarithm of the variance.
TEST(Level, OfVariancesOfSkewedSecondariesIsWhatTheirPValuesSay) {
  expect_level(1000, {{"claim: variance(pareto) == analytic, secondaries: 5000"},
                      {"claim: variance(pareto) <= analytic, secondaries: 5000"},
                      {"claim: variance(pareto) == 0.009917355371900827 * variance(normal), "
                       "secondaries: 5000"}});
}

// sup |Phi(x) - Phi(x - 0.5066942)| = 2 Phi(0.2533471) - 1 = .2.
TEST(Level, OfLawsIsWhatTheirPValuesSay) {
  expect_level(
      1000, {{"claim: 'distribution(normal) == normal(2, 1)', secondaries: 100"},
             {"claim: 'distribution(normal) == normal(2.5066942, 1)', allow: 0.2, secondaries: 100",
              Shape::at_most_uniform},
             {"claim: distribution(importance.x.x) == density, secondaries: 1280"},
             {"claim: distribution(normal) == distribution(again), secondaries: 100",
              Shape::at_most_uniform},
             {"claim: distribution(importance.x) == density, secondaries: 1280"}});
}

// Nine in ten values of `hits` are 0, the rest continuous. The smaller of two p-values counts
// twice, which is conservative; cells are asymptotic.
TEST(Level, OfTwoLawsInPartsAndInCellsIsWhatTheirPValuesSay) {
  expect_level(1000, {{"claim: distribution(hits) == distribution(hits_again), secondaries: 500",
                       Shape::at_most_uniform},
                      {"claim: distribution(ward.direction) == distribution(ward_again.direction), "
                       "test: chi-square-two-sample, secondaries: 2000",
                       Shape::at_most_uniform},
                      {"claim: distribution(normal) == distribution(again), "
                       "test: chi-square-two-sample, secondaries: 1000",
                       Shape::at_most_uniform}});
}

// Ward's density misses 2 % below the horizon, which the draws make up; an exact binomial test.
TEST(Level, OfIntegralsIsWhatTheirPValuesSay) {
  expect_level(1000,
               {{"claim: integral(ward.direction) == 1, secondaries: 2000", Shape::at_most_uniform},
                {"claim: integral(ward.direction) <= 0.99, allow: 0.01, secondaries: 2000",
                 Shape::at_most_uniform}});
}

// The reference is drawn anew for every seed from the law that its error declares.
TEST(Level, AgainstAnUncertainReferenceIsWhatThePValuesSay) {
  std::map<std::string, Outcomes> outcomes;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    tests::Philox random(401, static_cast<std::uint32_t>(seed));
    const std::string reference = fmt::format("{:.17g} +- 0.1", 2 + 0.1 * random.normal());
    const double pi = std::numbers::pi;
    const std::string of_darts = fmt::format("{:.17g} +- 0.1", pi + 0.1 * random.normal());
    const std::string text =
        suite_of({{"claim: mean(normal) == " + reference + ", secondaries: 100"},
                  {"claim: mean(normal) <= " + reference + ", secondaries: 100"},
                  {"claim: mean(normal) == " + reference + ", allow: 5%, secondaries: 100"},
                  {"claim: mean(darts) == " + of_darts + ", test: binomial, secondaries: 400"},
                  {"claim: mean(darts) <= " + of_darts + ", test: betting, secondaries: 400"}});
    take_first_looks(prepare_text(text, seed), seed, outcomes);
  }
  expect_p_value("==", outcomes.at("0").log_p, Shape::uniform);
  expect_p_value("<=", outcomes.at("1").log_p, Shape::uniform);
  expect_p_value("== up to 5 %", outcomes.at("2").log_p, Shape::at_most_uniform);
  expect_p_value("binomial", outcomes.at("3").log_p, Shape::at_most_uniform);
  expect_p_value("betting", outcomes.at("4").log_p, Shape::at_most_uniform);
}

// x is nearly noiseless and E y lies .78 standard errors from 0. The side of 0 that y falls on is
// chance, and so is the sign of a relative margin.
TEST(Level, OfARelativeMarginOfAMeanNearZeroIsKept) {
  const std::string text = R"(suite: near zero
estimators:
  x: {plugin: analytic/normal, mean: 0.117, deviation: 1e-6, primaries: 1}
  y: {plugin: analytic/normal, mean: 0.078, deviation: 1, primaries: 1}
tests:
  - {name: equal, claim: mean(x) == mean(y), allow: 50%, secondaries: 100}
  - {name: at most, claim: mean(x) <= mean(y), allow: 50%, secondaries: 100}
)";
  const auto outcomes = first_looks(tests::repetitions(2000), text);
  expect_as_in_runs(text);
  expect_p_value("==", outcomes.at("equal").log_p, Shape::at_most_uniform);
  expect_p_value("<=", outcomes.at("at most").log_p, Shape::at_most_uniform);
}

// Claims that are true only just, at the edge of what they allow.
TEST(Level, OfQuantilesCostsAndEfficienciesAtTheirMarginIsWhatThePValuesSay) {
  expect_level(1000, {{"claim: 'quantile(normal, 0.5) == 1.6', allow: 0.4, secondaries: 100",
                       Shape::at_most_uniform},
                      {"claim: 'quantile(normal, 0.5) <= 0.8 * quantile(again, 0.5)', allow: 0.4, "
                       "secondaries: 100",
                       Shape::at_most_uniform},
                      {"claim: cost(path) == 0.8 * cost(path_again), allow: 25%, secondaries: 200",
                       Shape::at_most_uniform},
                      {"claim: cost(path) <= 0.8 * cost(path_again), allow: 25%, secondaries: 200"},
                      {"claim: efficiency(normal) == 0.8 * efficiency(again), cost: samples, "
                       "allow: 25%, secondaries: 1200",
                       Shape::at_most_uniform},
                      {"claim: efficiency(normal) <= 0.8 * efficiency(again), cost: samples, "
                       "allow: 25%, secondaries: 1200"}});
}

// The reference of the second efficiency has the error 9.5: what it makes of the mean squared error
// is 90 times the variance.
TEST(Level, OfBiasesEfficienciesTotalsAndSlopesIsAtMostWhatThePValuesSay) {
  std::vector<TrueClaim> claims;
  for (const char* claim :
       {"bias(uniform) == 0, reference: importance, secondaries: 200",
        "efficiency(normal) == 1, cost: samples, secondaries: 1200",
        "efficiency(normal) == 1, cost: samples, reference: noisy, secondaries: 1000",
        "total_variance(normal) == 1, secondaries: 1200",
        "'quantile(normal, 0.5) == 2', secondaries: 300",
        "slope(variance(normal)) == 2, over: {deviation: [1, 2, 4]}, secondaries: 1200"}) {
    claims.push_back({std::string("claim: ") + claim, Shape::at_most_uniform});
  }
  expect_level(800, claims);
}

TEST(Level, OfSlopesAtTheirMarginIsWhatThePValuesSay) {
  expect_level(1000, {{"claim: slope(mean(normal)) == 0.9, allow: 0.1, over: {mean: [1, 2, 4]}, "
                       "secondaries: 100",
                       Shape::at_most_uniform},
                      {"claim: slope(variance(normal)) == 1.8, allow: 0.2, "
                       "over: {deviation: [1, 2, 4]}, secondaries: 1200",
                       Shape::at_most_uniform},
                      {"claim: slope(variance(normal)) <= 1.8, allow: 0.2, "
                       "over: {deviation: [1, 2, 4]}, secondaries: 1200",
                       Shape::at_most_uniform}});
}

TEST(Level, OfCellsAtTheirMarginIsWhatThePValuesSay) {
  expect_level(1000, {{fmt::format("claim: distribution(triangle.point) == density, "
                                   "allow: {:.17g}, secondaries: 20000",
                                   effect_of_triangle(20000))},
                      {"claim: distribution(narrow.direction) == density, secondaries: 5000"},
                      {fmt::format("claim: distribution(three_in_ten) == distribution(half), "
                                   "test: chi-square-two-sample, allow: {:.17g}, secondaries: 1000",
                                   effect_of_halves()),
                       Shape::at_most_uniform}});
}

TEST(Level, InLooksIsWhatThePValuesSay) {
  for (const char* claim :
       {"claim: mean(normal) == 2, detect: 0.3", "claim: mean(normal) >= mean(again), detect: 0.4",
        "claim: variance(normal) > variance(again), detect: 50%",
        "claim: 'distribution(normal) == normal(2, 1)', detect: 0.15"}) {
    expect_level_in_looks(150, {claim});
  }
}

TEST(Level, OfAWholeSuiteIsAtMostAlpha) {
  const Workplace place;
  const std::string file = place.write(
      "suite.yaml", suite_of({{"claim: mean(normal) == 2, secondaries: 20"},
                              {"claim: mean(normal) == mean(again), secondaries: 20"},
                              {"claim: variance(normal) == variance(again), secondaries: 50"},
                              {"claim: 'distribution(normal) == normal(2, 1)', secondaries: 50"},
                              {"claim: mean(wide) <= 4, secondaries: 20"}}));
  std::vector<double> smallest;
  for (std::uint64_t seed = 1; seed <= tests::repetitions(250); ++seed) {
    const reports::Record record = run_files({file}, {.seed = seed, .threads = 1});
    double least = 0;
    bool failed = false;
    for (const reports::Test& test : record.suites[0].tests) {
      least = std::min(least, log_of(test.channels.at(0).log10_p_adjusted));
      failed = failed || test.verdict == reports::Verdict::fail;
    }
    EXPECT_EQ(failed, least <= std::log(0.1)) << seed;
    smallest.push_back(least);
  }
  expect_p_value("Holm's least", smallest, Shape::at_most_uniform);
}

// 2.075 is three quarters of a standard error of 100 away: so little must already show.
TEST(Level, OfAClaimThatIsALittleWrongIsSeenToBeMore) {
  const std::size_t runs = tests::repetitions(2000);
  const auto outcomes =
      first_looks(runs, suite_of({{"claim: mean(normal) == 2.075, secondaries: 100"}}));
  EXPECT_TRUE(
      tests::too_many(rate_at(outcomes.at("0").log_p, 0.1), 0.1, static_cast<double>(runs)));
}

}  // namespace
}  // namespace assay::harness
