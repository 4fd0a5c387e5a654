// Claims about bias, cost, efficiency, quantiles, variances and slopes: what their records say.
// Their verdicts are in tests/tables/verdicts.txt, and levels in level_test.cpp.

#include "harness/sampling/group_variance.h"
#include "stats/basics/moments.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

const std::string estimators = R"(suite: claims
alpha: 0.0001
beta: 0.0001
estimators:
  uniform: {plugin: analytic/exponential_uniform, primaries: 64}
  scaled: {plugin: mutants/scaled, factor: 1.05, primaries: 64}
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  area: {plugin: luminaire/area, scene: triangle}
tests:
  - )";

reports::Test tested(const std::string& test) { return run_test(estimators + test + "\n"); }

TEST(MoreClaims, OfAFactorSayWhatTheEffectIsAgainst) {
  const auto quantity = [](const std::string& claim) {
    return tested("{claim: '" + claim + "', secondaries: 500}").channels[0].effect.quantity;
  };
  EXPECT_EQ(quantity("variance(uniform) < 2 * variance(scaled)"),
            "ln(ratio of variances to 2 times the second)");
  EXPECT_EQ(quantity("mean(uniform) == 0.5 * mean(scaled)"),
            "relative difference of means from 0.5 times the second");
  EXPECT_EQ(quantity("mean(uniform) == mean(scaled)"), "relative difference of means");
}

// Zeros and ones in equal number have kurtosis 1, and rounding takes it below 1. That must not end
// the run with an error.
TEST(MoreClaims, AVarianceOfTwoValuesIsComparedWhateverItsRounding) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const reports::Test test = run_test(
        "suite: coins\nalpha: 1e-6\nseed: " + std::to_string(seed) +
        "\nestimators:\n"
        "  normal: {plugin: analytic/normal, deviation: 0.5, primaries: 1}\n"
        "  coin: {plugin: analytic/law, law: bernoulli(0.5), primaries: 1}\n"
        "tests: [{claim: variance(normal) == variance(coin), secondaries: 16, test: F}]\n");
    EXPECT_NE(test.verdict, reports::Verdict::error) << seed << " " << test.message;
  }
}

// One value averages what it is made of, the other is an observation as a whole.
TEST(MoreClaims, AVarianceOfAPrimaryIsNotComparedToThatOfASecondary) {
  const Workplace place;
  const reports::Suite suite =
      run_files({place.write("suite.yaml",
                             "suite: kinds\nestimators:\n"
                             "  normal: {plugin: analytic/normal}\n"
                             "  other: {plugin: analytic/normal}\n"
                             "  ratio: {plugin: analytic/ratio, primaries: 64}\n"
                             "tests: [{claim: mean(normal) <= mean(ratio)}, "
                             "{claim: mean(normal) == mean(other)}]\n")})
          .suites[0];
  ASSERT_GE(suite.comparisons.size(), 2u);
  for (const reports::Comparison& pair : suite.comparisons) {
    EXPECT_TRUE(pair.mean_p) << pair.first << " " << pair.second;
    EXPECT_EQ(pair.variance_p.has_value(), pair.second == "other") << pair.second;
    EXPECT_EQ(pair.variance_ratio.has_value(), pair.second == "other") << pair.second;
  }
}

// Their kurtosis is 1 whatever the law: what would have been found is not known, and not asked for.
TEST(MoreClaims, OfAVarianceFromTwoObservationsSayNothingOfPower) {
  for (const char* claim :
       {"variance(n) <= 100", "variance(n) == 1", "variance(n) < variance(w)"}) {
    const reports::Test test = run_test(std::string("suite: s\nestimators:\n"
                                                    "  n: {plugin: analytic/normal}\n"
                                                    "  w: {plugin: analytic/normal, deviation: 9}\n"
                                                    "tests:\n  - {claim: '") +
                                        claim + "', secondaries: 2}\n");
    EXPECT_NE(test.verdict, reports::Verdict::error) << claim;
    EXPECT_FALSE(test.detectable) << claim;
  }
}

TEST(BiasClaim, ShowsTheReferenceOfTheTest) {
  const reports::Test shown =
      tested("{claim: bias(uniform) == 0, reference: 6.36 +- 0.01, detect: 0.2}");
  EXPECT_EQ(shown.verdict, Verdict::pass);
  EXPECT_EQ(shown.null_hypothesis, "bias(uniform) = 0, reference 6.36");
  EXPECT_EQ(shown.reference, "6.36 +- 0.01");
}

TEST(Budget, MayPayForTwoObservations) {
  const reports::Test least = tested("{claim: mean(uniform) == analytic, budget: 128}");
  EXPECT_EQ(least.samples[0].secondaries, 2u);
}

TEST(CostClaim, InSecondsTellsAFactorOfManyAndMarksTheRun) {
  // 64 primaries that trace a ray against one normal number.
  const reports::Record record = run_text(
      std::string(estimators) + "{claim: cost(area) > 1.5 * cost(normal), cost: seconds}\n");
  EXPECT_EQ(record.suites[0].tests[0].method, "replicates");
  EXPECT_TRUE(record.suites[0].timed);
}

// The number that the quantile is held against stands among the observations.
TEST(QuantileClaim, MarksItsNumberInTheHistogram) {
  const reports::Test test = tested("{claim: \"quantile(normal, 0.5) == 2\", detect: 0.2}");
  EXPECT_EQ(test.channels[0].reference, 2);
}

TEST(GroupVariance, OfTwoEqualChannelsIsTwiceTheSampleVarianceOfTheGroup) {
  GroupVariance groups({0, 2});
  stats::Moments one;
  std::optional<double> total;
  for (int i = 0; i < 8; ++i) {
    const double value = 1e6 + i * i;
    const double values[] = {value, 77, value};
    one.add(value);
    EXPECT_FALSE(total.has_value());
    total = groups.add(values);
  }
  ASSERT_TRUE(total.has_value());
  EXPECT_NEAR(*total, 2 * one.variance(), 1e-9 * one.variance());
}

TEST(GroupVariance, LeavesOutAGroupWithAValueThatIsNotFinite) {
  GroupVariance groups({0});
  for (int i = 0; i < 16; ++i) {
    const double values[] = {i == 3 ? std::nan("") : i};
    EXPECT_EQ(groups.add(values).has_value(), i == 15) << i;
  }
}

}  // namespace
}  // namespace assay::harness
