#include "harness/run/verdict_text.h"

#include <fmt/format.h>

#include "harness/plan/looks.h"
#include "harness/suite/run_options.h"
#include "reports/words/effect.h"
#include "tests/harness/questions.h"
#include "tests/harness/recorded_rows.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"
#include "tests/stats/samples.h"

namespace assay::harness {
namespace {

using reports::Verdict;

reports::Test told(const std::string& test) {
  return test_named(run_text(R"(suite: told
estimators:
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  other: {plugin: analytic/normal, mean: 2.01, primaries: 1}
  averaged: {plugin: analytic/normal, mean: 2, primaries: 16}
  unit: {plugin: analytic/normal, mean: 2, deviation: 0.1, primaries: 1}
tests:
  - {name: test, )" + test + "}\n"),
                    "test");
}

void expect_said(const reports::Test& test, Verdict verdict, const std::string& words) {
  EXPECT_EQ(test.verdict, verdict) << test.message;
  EXPECT_THAT(test.message, HasSubstr(words));
}

// Only the pilot knows the other mean, and another seed may change it. So this is no mistake for
// certain.
TEST(Narrate, PassByAMarginBeyondTheOtherMeanSaysSo) {
  const auto beside_rows = [](double mean, const std::string& margin) {
    const Workplace place;
    place.write(
        "rows.txt",
        file_of(rows_of(400, 5, [mean](Philox& random) { return mean + random.normal(); })));
    return run_files({place.write("suite.yaml",
                                  "suite: s\nestimators:\n"
                                  "  rows: {plugin: recorded, file: rows.txt}\n"
                                  "  mine: {plugin: analytic/normal, mean: " +
                                      fmt::format("{}", mean) + "}\ntests: [{claim: mean(mine) " +
                                      margin + "}]\n")})
        .suites[0]
        .tests[0];
  };
  expect_said(beside_rows(2, "== mean(rows), detect: 5"), Verdict::pass,
              "; the margin 5 is larger than");
  expect_said(beside_rows(2, "within 5 of mean(rows)"), Verdict::pass,
              ": for 5 per cent write `5%`");
  for (const auto& [mean, margin] : {std::pair(2., "1"), std::pair(0., "5")}) {
    const reports::Test test = beside_rows(mean, std::string("== mean(rows), detect: ") + margin);
    EXPECT_EQ(test.verdict, Verdict::pass);
    EXPECT_THAT(test.message, testing::Not(HasSubstr("the margin")));
  }
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
    return narrate(outcome);
  };
  EXPECT_TRUE(said({.quantity = "difference from the claimed slope"})
                  .starts_with("difference from the claimed slope is no finite number, p = "));
  EXPECT_TRUE(
      said({.quantity = "difference from the claimed slope", .high = -3., .confidence = .98})
          .starts_with("difference from the claimed slope is no finite number [to -3] "
                       "(98 % interval), p = "));
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
  EXPECT_EQ(narrate(outcome),
            "no evidence against the claim; 0.05 or more is excluded, p = 0.013; the data lie "
            "closer to the claim than chance leads to expect, so that there is no 92 % interval");
}

// 2.9 standard errors off, which a share of .001 does not refute and an interval at 90 % leaves
// out.
TEST(Narrate, APassWhoseIntervalLeavesTheClaimOutSaysThatEvidenceIsTooLittle) {
  std::vector<double> rows = rows_of(1000, 21, normal);
  const stats::Moments moments = tests::moments_of(rows);
  std::string text;
  for (double& row : rows) {
    row += 2.9 * moments.standard_error() - moments.mean;
    text += fmt::format("{:.17g}\n", row);
  }
  const Workplace place;
  place.write("rows.txt", text);
  const reports::Test test =
      run_files({place.write("suite.yaml",
                             "suite: s\nalpha: 0.001\nbeta: 0.05\nestimators:\n"
                             "  rows: {plugin: recorded, file: rows.txt}\n"
                             "tests: [{claim: mean(rows) == 0, detect: 1}]\n")})
          .suites[0]
          .tests[0];
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_GT(*test.channels[0].effect.low, 0);
  EXPECT_THAT(test.message, testing::StartsWith(
                                "not enough evidence against the claim, p = 0.0038 where its share "
                                "of alpha is 0.001; "));
}

TEST(Narrate, InconclusiveSaysHowManyPrimariesThatWouldBe) {
  const reports::Test test = told("claim: mean(averaged) == 2, detect: 0.5%, secondaries: 1000");
  expect_said(test, Verdict::inconclusive, " primaries) would decide");
  double secondaries = 0;
  double primaries = 0;
  const std::size_t at = test.message.find("about ");
  ASSERT_NE(at, std::string::npos);
  ASSERT_EQ(std::sscanf(test.message.c_str() + at, "about %lf secondaries (%lf primaries)",
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
    RunOptions options;
    options.seed = seed;
    const reports::Test test = test_named(
        run_text("suite: few\nestimators:\n  normal: {plugin: analytic/normal, primaries: 1}\n"
                 "tests:\n  - {claim: mean(normal) == 0, detect: 0.8, secondaries: 3}\n",
                 options),
        "mean(normal) == 0");
    double advice = 0;
    const std::size_t at = test.message.find("about ");
    if (at == std::string::npos) continue;
    ASSERT_EQ(std::sscanf(test.message.c_str() + at, "about %lf secondaries", &advice), 1);
    sum += advice;
    ++told;
  }
  ASSERT_GE(told, 15);
  EXPECT_LT(sum / told, 2 * 37.5);
}

// The words "12.3 % or more is excluded by the 98 % interval" beside that interval.
TEST(Narrate, TheIntervalOfAPassIsTheOneThatExcludes) {
  const reports::Test test = told("claim: mean(normal) == 2, detect: 10%, secondaries: 10000");
  const reports::Effect& effect = test.channels[0].effect;
  EXPECT_EQ(test.verdict, Verdict::pass);
  EXPECT_DOUBLE_EQ(effect.confidence, 1 - 2 * *test.beta);
  EXPECT_LT(*effect.high, 0.1);
  EXPECT_GT(*effect.low, -0.1);
  expect_said(test, Verdict::pass, " % or more is excluded by the 98 % interval");
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
                fmt::format("{:.3g} % or more is excluded", 100 * (upper ? high : low)));
  }
}

TEST(Narrate, TheIntervalOfAFailIsTheOneThatRefutes) {
  const reports::Test test = told("claim: mean(normal) == 2.5, detect: 10%, secondaries: 10000");
  EXPECT_EQ(test.verdict, Verdict::fail);
  EXPECT_DOUBLE_EQ(test.channels[0].effect.confidence, 1 - *test.alpha);
  EXPECT_LT(*test.channels[0].effect.high, 0);
}

// A pass that excludes nothing rests on the test at alpha.
TEST(Narrate, TheIntervalOfAClassicalPassIsAtAlpha) {
  const reports::Test test = told("claim: mean(normal) == 2");
  EXPECT_DOUBLE_EQ(test.channels[0].effect.confidence, 1 - *test.alpha);
}

TEST(Narrate, TheIntervalOfAProofLiesInsideItsMargin) {
  const reports::Test test = told("claim: mean(normal) within 10% of 2, secondaries: 10000");
  const reports::Effect& effect = test.channels[0].effect;
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_DOUBLE_EQ(effect.confidence, 1 - 2 * *test.beta);
  EXPECT_LT(*effect.high, 0.1);
  EXPECT_GT(*effect.low, -0.1);
}

// In words and in the columns of the reports.
TEST(Narrate, ShowsANumberInTheFormThatReportsShowItIn) {
  const reports::Test factor = told("claim: variance(other) == 0.01");
  const std::string shown =
      reports::theta_text(*factor.channels[0].effect.estimate, factor.channels[0].effect);
  EXPECT_TRUE(shown.starts_with("×")) << shown;
  expect_said(factor, Verdict::fail, "is " + shown + " [");
}

}  // namespace
}  // namespace assay::harness
