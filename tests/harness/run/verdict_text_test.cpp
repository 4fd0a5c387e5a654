#include <fmt/format.h>

#include "harness/plan/outcome.h"
#include "harness/run/evaluate.h"
#include "reports/words/number.h"
#include "tests/harness/prelude.h"
#include "tests/harness/questions.h"
#include "tests/harness/recorded_rows.h"
#include "tests/harness/table.h"
#include "tests/stats/samples.h"

namespace assay::harness {
namespace {

reports::Test told(const std::string& test) {
  return run_test(suite_with("words", "{" + test + "}"), {});
}

// An exponent of points of which one alone is not zero is infinite.
TEST(Narrate, WithoutANumberSaysThatThereIsNone) {
  const auto asked = ask_text(R"(suite: none
estimators: {area: {plugin: luminaire/area}}
tests: [{name: t, claim: mean(area) == 1}]
)");
  const auto said = [&](const reports::Effect& effect) {
    TestOutcome outcome{.question = asked->question("t")};
    outcome.verdict = Verdict::fail;
    ChannelOutcome& channel = outcome.channels.emplace_back();
    channel.effect = effect;
    channel.decision.log_p_claimed = -14;
    return narrate(outcome).text;
  };
  EXPECT_TRUE(said({.quantity = "difference from the claimed slope"})
                  .starts_with("difference from the claimed slope is no finite number, p = "));
  EXPECT_TRUE(
      said({.quantity = "difference from the claimed slope", .high = -3., .confidence = .98})
          .starts_with("difference from the claimed slope is no finite number (98 % "
                       "interval: at most -3), p = "));
}

// An interval that excludes even no effect has an end that excludes nothing.
TEST(Narrate, PassWithAnEmptyIntervalSaysWhatTheTestExcludes) {
  const auto asked = ask_text(R"(suite: even
estimators: {area: {plugin: luminaire/area}}
tests: [{name: t, claim: distribution(area.point) == density, detect: 0.05}]
)");
  TestOutcome outcome{.question = asked->question("t")};
  outcome.verdict = Verdict::pass;
  outcome.plan.looks = one_look(1000, outcome.place.share);
  ChannelOutcome channel{.regions = {.detect = 0.05}};
  channel.evidence.distance = true;
  channel.decision.log_p_forbidden = std::log(0.0125);
  channel.effect = {.quantity = "effect size w", .estimate = 0., .confidence = 0.92};
  outcome.channels = {channel};
  EXPECT_EQ(narrate(outcome).text,
            "no evidence against the claim; 0.05 or more is excluded, p = 0.013; the data lie "
            "closer to the claim than chance leads to expect, so that there is no 92 % interval");
}

// 2.9 standard errors off, which a share of .001 does not refute and an interval at 98 % leaves
// out.
TEST(Narrate, APassWhoseIntervalLeavesTheClaimOutSaysThatEvidenceIsTooLittle) {
  std::vector<double> rows = rows_of(1000, 21, normal);
  const stats::Moments moments = tests::moments_of(rows);
  for (double& row : rows) row += 2.9 * moments.standard_error() - moments.mean;
  const reports::Test test = judged(rows, "claim: mean(rows) == 0, detect: 1", 0.001);
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_GT(*test.channels[0].effect.low, 0);
  EXPECT_THAT(test.message, testing::StartsWith(
                                "not enough evidence against the claim, p = 0.0038 where its share "
                                "of alpha is 0.001; "));
}

TEST(Narrate, InconclusiveSaysHowManyPrimariesThatWouldBe) {
  const reports::Test test = told("claim: mean(averaged) == 2, detect: 0.5%, secondaries: 1000");
  expect_said(test, Verdict::inconclusive, {" primaries) would decide"});
  double secondaries = 0, primaries = 0;
  const std::size_t at = test.message.find("secondaries: ");
  ASSERT_NE(at, std::string::npos);
  ASSERT_EQ(std::sscanf(test.message.c_str() + at, "secondaries: %lf` (%lf primaries)",
                        &secondaries, &primaries),
            2);
  EXPECT_NEAR(primaries / secondaries, 16, 1) << "two digits of each are shown";
}

// (2.576 + 2.326)^2 / .8^2 = 37.5 observations of deviation 1 are needed. Three observations
// estimate the deviation with 2 degrees of freedom. Their squared t interval is nine times as wide
// as a normal one. The mean of s^2 over 20 seeds exceeds 2 with probability 2e-4.
TEST(Narrate, AdviceFromFewObservationsIsNotThatOfTheirWideInterval) {
  double sum = 0;
  int told = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const reports::Test test = run_test(
        "suite: few\nestimators:\n  normal: {plugin: analytic/normal, primaries: 1}\n"
        "tests:\n  - {claim: mean(normal) == 0, detect: 0.8, secondaries: 3}\n",
        {.seed = seed});
    if (!test.advice) continue;
    EXPECT_EQ(test.advice->key, "secondaries");
    EXPECT_THAT(test.message, testing::HasSubstr("`secondaries: " + test.advice->value + "`"));
    sum += std::stod(test.advice->value);
    ++told;
  }
  ASSERT_GE(told, 15);
  EXPECT_LT(sum / told, 2 * 37.5);
}

// The larger of the ends as they are shown: upwards a ratio has more per cent than downwards.
TEST(Narrate, WhatIsExcludedOfARatioIsAnEndOfItsInterval) {
  for (const char* side : {"== 0.01", "<= 0.01"}) {
    const reports::Test test =
        told(std::string("claim: variance(unit) ") + side + ", detect: 40%, secondaries: 1000");
    const reports::Effect& effect = test.channels[0].effect;
    const double high = std::abs(std::expm1(*effect.high));
    const double low = std::abs(std::expm1(*effect.low));
    const bool upper = std::string(side).starts_with("<") || high > low;
    expect_said(test, Verdict::pass,
                {fmt::format("{:.3g} % or more is excluded", 100 * (upper ? high : low))});
  }
}

// A pass that excludes nothing rests on the test at alpha, as a fail does.
TEST(Narrate, ShowsTheIntervalThatExcludesOrRefutes) {
  struct Shown {
    const char* claim;
    Verdict verdict;
    bool at_beta;
  };
  for (const Shown& each :
       {Shown{"== 2, detect: 10%", Verdict::pass, true},
        Shown{"within 10% of 2", Verdict::pass, true}, Shown{"== 2", Verdict::pass, false},
        Shown{"== 2.5, detect: 10%", Verdict::fail, false}}) {
    const reports::Test test =
        told(std::string("claim: mean(normal) ") + each.claim + ", secondaries: 10000");
    const reports::Effect& effect = test.channels[0].effect;
    expect_said(test, each.verdict);
    EXPECT_DOUBLE_EQ(effect.confidence, 1 - (each.at_beta ? 2 * *test.beta : *test.alpha));
    EXPECT_LT(*effect.high, each.verdict == Verdict::fail ? 0 : 0.1) << each.claim;
    EXPECT_GT(*effect.low, each.verdict == Verdict::fail ? -1 : -0.1) << each.claim;
  }
}

// In words and in the columns of the reports.
TEST(Narrate, ShowsANumberInTheFormThatReportsShowItIn) {
  const reports::Test factor = told("claim: variance(other) == 0.01");
  const std::string shown =
      reports::theta_text(*factor.channels[0].effect.estimate, factor.channels[0].effect);
  EXPECT_TRUE(shown.starts_with("×")) << shown;
  expect_said(factor, Verdict::fail, {"is " + shown + " ("});
}

}  // namespace
}  // namespace assay::harness
