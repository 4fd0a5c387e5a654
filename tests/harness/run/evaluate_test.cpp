#include "harness/run/evaluate.h"

#include "harness/families/families.h"
#include "harness/plan/looks.h"
#include "tests/harness/normal_evidence.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

constexpr double alpha = 0.05;

/// A judged test of one channel with this p-value.
TestWork judged_by_p(double p, double weight, Verdict verdict, const TestEntry& test) {
  TestWork work;
  TestOutcome& outcome = work.outcome;
  outcome.question.test = &test;
  outcome.question.theta = &theta_of_means();
  outcome.question.subjects = {Subject{.channels = {0, 1, 1}}};
  outcome.place = {.inside = true, .weight = weight, .share = {alpha * weight, 0.01}};
  outcome.plan.regions = {Regions{.relation = Relation::equal}};
  outcome.plan.looks = one_look(1000, outcome.place.share);
  outcome.verdict = verdict;
  ChannelOutcome& channel = outcome.channels.emplace_back();
  channel.name = "value";
  channel.evidence = normal_evidence(2, 1);
  channel.decision.log_p_claimed = std::log(p);
  outcome.history = {{.log_p_claimed = {std::log(p)}, .log_p_forbidden = {0}}};
  return work;
}

std::vector<double> adjusted(std::vector<TestWork> tests) {
  adjust_p_values(tests);
  std::vector<double> p;
  for (const TestWork& work : tests) {
    for (const ChannelOutcome& channel : work.outcome.channels) {
      p.push_back(std::exp(channel.log_p_adjusted));
    }
  }
  return p;
}

// The first p takes all of alpha, the second what the first leaves.
TEST(Evaluate, HolmAdjustsByTheSharesThatSmallerPValuesFree) {
  const TestEntry test;
  const auto with = [&](Verdict first) {
    return adjusted(
        {judged_by_p(1e-9, 0.5, first, test), judged_by_p(0.03, 0.5, Verdict::pass, test)});
  };
  EXPECT_THAT(with(Verdict::fail), Pointwise(DoubleNear(1e-15), {2e-9, 0.03}));
  // Invalid and error count as p = 1 and free nothing.
  for (const Verdict verdict : {Verdict::invalid, Verdict::error}) {
    EXPECT_THAT(with(verdict), Pointwise(DoubleNear(1e-15), {1., 0.06}));
  }
}

TEST(Evaluate, HolmCountsATestWithoutNumbersAsNotRejected) {
  const TestEntry test;
  TestWork without = judged_by_p(1e-9, 0.5, Verdict::error, test);
  without.outcome.channels.clear();
  EXPECT_THAT(adjusted({without, judged_by_p(0.03, 0.5, Verdict::pass, test)}),
              Pointwise(DoubleNear(1e-15), {0.06}));
}

TEST(Evaluate, HolmIsNotForTestsOutsideTheFamily) {
  const TestEntry test;
  TestWork outside = judged_by_p(0.03, 0.5, Verdict::pass, test);
  outside.outcome.place.inside = false;
  const double before = outside.outcome.channels[0].log_p_adjusted;
  EXPECT_THAT(adjusted({judged_by_p(1e-9, 1, Verdict::fail, test), outside}),
              Pointwise(DoubleNear(1e-15), {1e-9, std::exp(before)}));
}

reports::Test judged_text(const std::string& estimator, const std::string& test) {
  return run_test("suite: one\nestimators:\n  it: {plugin: " + estimator + "}\ntests:\n  - {" +
                  test + "}\n");
}

TEST(Evaluate, BinomialTestsQuoteTheirOwnPower) {
  const reports::Test test = judged_text("analytic/dart_throwing, primaries: 1",
                                         "claim: mean(it) == analytic, detect: 2%");
  EXPECT_EQ(test.method, "binomial");
  EXPECT_EQ(test.verdict, Verdict::pass);
  ASSERT_TRUE(test.power && test.detectable);
  EXPECT_GE(*test.power, 0.99);
  EXPECT_LE(*test.detectable, 0.02);
}

TEST(Evaluate, ForcedMethodIsNotInvalidatedByItsGates) {
  const reports::Test test = judged_text("analytic/heavy_tail, primaries: 1",
                                         "claim: mean(it) == analytic, secondaries: 100, test: t");
  EXPECT_NE(test.verdict, Verdict::invalid);
  EXPECT_TRUE(std::any_of(test.gates.begin(), test.gates.end(),
                          [](const reports::Gate& gate) { return gate.state == "red"; }));
}

// Its range is that number but for rounding: nothing unseen can move its mean.
TEST(Evaluate, ZeroVarianceInADeclaredRangePassesAtItsFirstLook) {
  const reports::Test test =
      judged_text("analytic/zero_variance", "claim: mean(it) == analytic, detect: 0.5%");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_LE(test.samples[0].secondaries, 1000);
}

}  // namespace
}  // namespace assay::harness
