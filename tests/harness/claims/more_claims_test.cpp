// Claims about bias, cost, efficiency, quantiles, variances and slopes, from YAML to verdict. True
// claims pass, and each quantity's defect fails. True claims raise an alarm no more often than
// alpha.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "harness/sampling/group_variance.h"
#include "stats/basics/moments.h"
#include "stats/means/binomial.h"
#include "tests/harness/questions.h"
#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/stats/calibration.h"

namespace assay::harness {
namespace {

using reports::Verdict;
using testing::HasSubstr;

const std::string estimators = R"(suite: claims
alpha: 0.0001
beta: 0.0001
estimators:
  uniform: {plugin: analytic/exponential_uniform, primaries: 64}
  importance: {plugin: analytic/exponential_importance, primaries: 64}
  scaled: {plugin: mutants/scaled, factor: 1.05, primaries: 64}
  wis: {plugin: analytic/ratio, primaries: 8}
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  noisy: {plugin: analytic/normal, mean: 2, deviation: 300, primaries: 1}
  area: {plugin: luminaire/area, scene: triangle}
  hemisphere: {plugin: luminaire/hemisphere, scene: triangle}
tests:
  - )";

reports::Test tested(const std::string& test) { return run_test(estimators + test + "\n"); }

Verdict verdict_of(const std::string& test) { return run_verdict(estimators + test + "\n"); }

std::string refused(const std::string& test) {
  return refusal([&] { ask_text(estimators + test + "\n"); });
}

// Verdicts below are right with probability 1 - alpha - beta = 0.9998 at least, with the seed 1.

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

TEST(BiasClaim, IsHeldAgainstTheAnalyticMean) {
  EXPECT_EQ(verdict_of("{claim: bias(uniform) == 0, detect: 2%}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: bias(uniform) within 2% of 0}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: bias(scaled) == 0, detect: 2%}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: bias(scaled) <= 0.1, detect: 0.2}"), Verdict::fail);
  // 5 % of 6.361846.
  EXPECT_EQ(verdict_of("{claim: bias(scaled) within 0.1 of 0.3180923}"), Verdict::pass);
}

TEST(BiasClaim, IsHeldAgainstAReferenceOfTheTest) {
  EXPECT_EQ(verdict_of("{claim: bias(uniform) == 0, reference: importance, detect: 2%}"),
            Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: bias(scaled) == 0, reference: importance, detect: 2%}"),
            Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: bias(uniform) <= 0, reference: 6, detect: 0.1}"), Verdict::fail);
  const reports::Test shown =
      tested("{claim: bias(uniform) == 0, reference: 6.36 +- 0.01, detect: 0.2}");
  EXPECT_EQ(shown.verdict, Verdict::pass);
  EXPECT_EQ(shown.null_hypothesis, "bias(uniform) = 0, reference 6.36");
  EXPECT_EQ(shown.reference, "6.36 +- 0.01");
}

TEST(BiasClaim, RefusesWhatItCannotMean) {
  EXPECT_THAT(refused("claim: bias(uniform) == bias(importance)"),
              HasSubstr("compared with a number"));
  EXPECT_THAT(refused("claim: bias(uniform) within 1% of 0.5"), HasSubstr("per cent of what"));
  EXPECT_THAT(refused("{claim: bias(uniform) == 0, reference: absent}"),
              HasSubstr("no estimator `absent`"));
}

TEST(CostClaim, OfACostThatNeverVariesIsExact) {
  EXPECT_EQ(verdict_of("{claim: cost(area) == 1}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: cost(area) == cost(hemisphere)}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: cost(area) <= 0.999}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: cost(area) <= 0.999 * cost(hemisphere)}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: cost(wis) == 8, cost: samples}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: cost(wis) <= cost(normal), cost: samples}"), Verdict::fail);
}

// The end of an open region does not belong to it.
TEST(CostClaim, OfACostThatNeverVariesRefutesTheProofAtItsEnd) {
  EXPECT_EQ(verdict_of("claim: cost(area) < 1"), Verdict::fail);
  EXPECT_EQ(verdict_of("claim: cost(area) > cost(hemisphere)"), Verdict::fail);
  EXPECT_EQ(verdict_of("claim: cost(area) < 1.001"), Verdict::pass);
  EXPECT_EQ(verdict_of("claim: cost(area) > 0.999"), Verdict::pass);
}

TEST(Budget, ThatPaysForNoTestIsRefused) {
  EXPECT_THAT(
      refusal([] { run_text(estimators + "{claim: mean(uniform) == analytic, budget: 127}\n"); }),
      HasSubstr("does not pay for two observations, the fewest that can be tested: these take "
                "128"));
  const reports::Test least = tested("{claim: mean(uniform) == analytic, budget: 128}");
  EXPECT_EQ(least.samples[0].secondaries, 2u);
}

TEST(CostClaim, WithoutAnythingCountedIsInvalid) {
  const reports::Test test = tested("{claim: cost(normal) <= 1}");
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_THAT(test.message, HasSubstr("cost: samples"));
}

TEST(CostClaim, RefusesZeroAndErrors) {
  EXPECT_THAT(refused("claim: cost(area) <= 0"), HasSubstr("above 0"));
  EXPECT_THAT(refused("claim: cost(area) <= 2 +- 1"), HasSubstr("exact number"));
  EXPECT_THAT(refused("{claim: cost(area) <= cost(wis), detect: 0.1}"),
              HasSubstr("ratio of costs"));
}

TEST(CostClaim, InSecondsTellsAFactorOfManyAndMarksTheRun) {
  // 64 primaries that trace a ray against one normal number.
  const reports::Record record = run_text(
      std::string(estimators) + "{claim: cost(area) > 1.5 * cost(normal), cost: seconds}\n");
  EXPECT_EQ(record.suites[0].tests[0].method, "replicates");
  EXPECT_TRUE(record.suites[0].timed);
}

TEST(EfficiencyClaim, WeighsVarianceAgainstCost) {
  EXPECT_EQ(verdict_of("claim: efficiency(area) > 1.1 * efficiency(hemisphere)"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: efficiency(hemisphere) >= efficiency(area), detect: 10%}"),
            Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: efficiency(normal) == 1, cost: samples, detect: 20%}"),
            Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: efficiency(normal) >= 1.5, cost: samples, detect: 10%}"),
            Verdict::fail);
}

TEST(EfficiencyClaim, OfABiasedEstimatorTakesTheMeanSquaredError) {
  // With 64 primaries the original has the variance 0.416. The mutant has 1.1025 times that, so its
  // efficiency is 0.907. Its bias of 0.318 makes the mean squared error 0.560, and the efficiency
  // 0.743.
  EXPECT_EQ(verdict_of("{claim: efficiency(scaled) >= 0.85 * efficiency(uniform), cost: samples, "
                       "detect: 10%}"),
            Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: efficiency(scaled) >= 0.85 * efficiency(uniform), cost: samples, "
                       "reference: 6.361845641, detect: 10%}"),
            Verdict::fail);
}

// The number that the quantile is held against stands among the observations.
TEST(QuantileClaim, MarksItsNumberInTheHistogram) {
  const reports::Test test = tested("{claim: \"quantile(normal, 0.5) == 2\", detect: 0.2}");
  EXPECT_EQ(test.channels[0].reference, 2);
}

// 500 observations say nothing of how low the quantile of 1/10000 lies.
TEST(QuantileClaim, ThatNothingCouldRefuteSaysSo) {
  const auto message = [](const std::string& claim) {
    return tested("{claim: '" + claim + "', secondaries: 500}").message;
  };
  const std::string low = "exclude no smaller quantile at all";
  const std::string high = "exclude no larger quantile at all";
  EXPECT_THAT(message("quantile(normal, 0.0001) == -100"), HasSubstr(low));
  EXPECT_THAT(message("quantile(normal, 0.0001) <= 1"), HasSubstr(low));
  EXPECT_THAT(message("quantile(normal, 0.9999) >= 3"), HasSubstr(high));
  EXPECT_THAT(message("quantile(normal, 0.0001) >= -100"), testing::Not(HasSubstr("exclude no")));
  EXPECT_THAT(message("quantile(normal, 0.5) == 2"), testing::Not(HasSubstr("exclude no")));
}

TEST(QuantileClaim, IsExactOfOneAndOfTwo) {
  EXPECT_EQ(verdict_of("{claim: \"quantile(normal, 0.5) == 2\", detect: 0.2}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: \"quantile(normal, 0.5) == 2.3\", detect: 5%}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: \"quantile(normal, 0.9) <= 2.8\", detect: 0.2}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: \"quantile(normal, 0.9) == quantile(normal, 0.9)\", detect: 0.2}"),
            Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: \"quantile(normal, 0.9) == 1.5 * quantile(normal, 0.9)\", "
                       "detect: 0.2}"),
            Verdict::fail);
}

TEST(QuantileClaim, RefusesTwoProbabilities) {
  EXPECT_THAT(refused("claim: quantile(normal, 0.5) == quantile(normal, 0.9)"),
              HasSubstr("same probability"));
}

TEST(TotalVarianceClaim, AddsTheChannels) {
  EXPECT_EQ(verdict_of("{claim: total_variance(normal) == 1, detect: 20%}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: total_variance(normal) <= 0.7, detect: 20%}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: total_variance(hemisphere) <= total_variance(area), detect: 20%}"),
            Verdict::fail);
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

TEST(SlopeClaim, SeesTheBiasOfARatioVanishLikeOneOverN) {
  const std::string over = ", over: {primaries: [8, 16, 32, 64]}}";
  EXPECT_EQ(verdict_of("{claim: slope(bias(wis)) within 0.15 of -1" + over), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: slope(variance(wis)) within 0.15 of -1" + over), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: slope(cost(wis)) == 1, cost: samples" + over), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: slope(variance(wis)) == -2, detect: 0.2" + over), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: slope(cost(wis)) <= 0.9, cost: samples" + over), Verdict::fail);
}

TEST(SlopeClaim, SweepsAParameterOfThePlugin) {
  // The variance is the square of the standard deviation.
  EXPECT_EQ(
      verdict_of("{claim: slope(variance(normal)) within 0.2 of 2, over: {deviation: [1, 2, 4]}}"),
      Verdict::pass);
  // The factor scales the whole estimate: its mean goes like the factor itself.
  EXPECT_EQ(verdict_of("{claim: slope(mean(scaled)) within 0.1 of 1, over: {factor: [1, 2, 4]}}"),
            Verdict::pass);
}

TEST(SlopeClaim, ReferenceMayBeAnEstimatorOrANumber) {
  EXPECT_EQ(verdict_of("{claim: slope(bias(wis)) <= -0.5, reference: 6.361845641, "
                       "over: {primaries: [2, 4, 8]}}"),
            Verdict::pass);
  // Far from the truth the bias does not vanish.
  EXPECT_EQ(verdict_of("{claim: slope(bias(wis)) <= -0.5, reference: 3, "
                       "over: {primaries: [2, 4, 8]}}"),
            Verdict::fail);
}

// An unbiased estimator has no exponent: none has a small p-value.
TEST(SlopeClaim, OfWhatIsNotSeenSaysThatNothingCouldHaveBeenFound) {
  const auto message_of = [](const std::string& test) { return tested(test).message; };
  const std::string over = ", over: {primaries: [8, 16, 32]}}";
  EXPECT_THAT(message_of("{claim: slope(bias(uniform)) == -1" + over),
              HasSubstr("exclude no exponent"));
  EXPECT_THAT(message_of("{claim: slope(variance(wis)) == -1" + over),
              testing::Not(HasSubstr("exclude no exponent")));
}

TEST(SlopeClaim, RefusesWhatHasNoSlope) {
  const std::string over = ", over: {primaries: [8, 16]}}";
  EXPECT_THAT(refused("{claim: slope(efficiency(wis)) == 1" + over),
              HasSubstr("takes a mean, bias"));
  EXPECT_THAT(refused("{claim: slope(bias(wis)) within 10% of -1" + over), HasSubstr("exponent"));
  EXPECT_THAT(refused("{claim: slope(cost(wis)) == 1, cost: seconds" + over),
              HasSubstr("no method"));
}

TEST(TotalVarianceClaim, OfWhatDoesNotVaryNamesIt) {
  const reports::Test test = run_test(
      "suite: s\nestimators:\n  still: {plugin: analytic/zero_variance}\n  moving: {plugin: "
      "analytic/normal}\ntests:\n  - {claim: total_variance(still) < total_variance(moving)}\n");
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_THAT(test.message, HasSubstr("no channel of `still` varies"));
}

TEST(WorstVarianceClaim, IsAboutEveryChannel) {
  EXPECT_EQ(verdict_of("{claim: worst_variance(normal) <= 1.5, detect: 20%}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: worst_variance(normal) <= 0.7, detect: 20%}"), Verdict::fail);
}

/// True if so many alarms in the runs of true claims are likelier than 1e-5 at alpha = 0.1, the
/// suite's. The seeds are 1, 2, 3, ….
bool keeps_alpha(const std::string& test) {
  const std::uint64_t runs = tests::repetitions(200);
  std::string text = estimators + test + "\n";
  text.replace(text.find("0.0001"), 6, "0.1");
  const Workplace place;
  const std::string file = place.write("suite.yaml", text);
  std::uint64_t alarms = 0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    alarms +=
        run_files({file}, {.seed = seed, .threads = 1}).suites[0].tests[0].verdict == Verdict::fail;
  }
  testing::Test::RecordProperty("alarms", static_cast<int>(alarms));
  return stats::binomial({alarms, runs}, 0.1).log_p_upper > std::log(1e-5);
}

// The reference of the second efficiency has the error 9.5: what it makes of the mean squared error
// is 90 times the variance.
TEST(MoreClaimsLevel, IsAtMostAlpha) {
  for (const char* test :
       {"{claim: bias(uniform) == 0, reference: importance, secondaries: 200}",
        "{claim: efficiency(normal) == 1, cost: samples, secondaries: 1000}",
        "{claim: efficiency(normal) == 1, cost: samples, reference: noisy, secondaries: 1000}",
        "{claim: total_variance(normal) == 1, secondaries: 1000}",
        "{claim: \"quantile(normal, 0.5) == 2\", secondaries: 300}",
        "{claim: slope(variance(normal)) == 2, over: {deviation: [1, 2, 4]}, secondaries: 1000}"}) {
    EXPECT_TRUE(keeps_alpha(test)) << test;
  }
}

// The same machinery calls a wrong level wrong: 1.1 is two standard errors of ln s2 away.
TEST(MoreClaimsLevel, IsMoreThanAlphaWhereOneIsWrong) {
  EXPECT_FALSE(keeps_alpha("{claim: efficiency(normal) == 1.1, cost: samples, secondaries: 1000}"));
}

}  // namespace
}  // namespace assay::harness
