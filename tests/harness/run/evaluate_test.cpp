#include "harness/run/evaluate.h"

#include <fmt/format.h>

#include "harness/families/families.h"
#include "harness/plan/looks.h"
#include "harness/run/holm.h"
#include "tests/harness/normal_evidence.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

constexpr double alpha = 0.05;

/// A judged test of one channel with this p-value.
TestWork judged(double p, double weight, Verdict verdict, const TestEntry& test) {
  TestWork work;
  TestOutcome& outcome = work.outcome;
  outcome.question.test = &test;
  outcome.question.theta = &theta_of_means();
  outcome.question.subjects = {Subject{.channels = {0}}};
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
    return adjusted({judged(1e-9, 0.5, first, test), judged(0.03, 0.5, Verdict::pass, test)});
  };
  EXPECT_THAT(with(Verdict::fail), Pointwise(DoubleNear(1e-15), {2e-9, 0.03}));
  // Invalid and error count as p = 1 and free nothing.
  for (const Verdict verdict : {Verdict::invalid, Verdict::error}) {
    EXPECT_THAT(with(verdict), Pointwise(DoubleNear(1e-15), {1., 0.06}));
  }
}

TEST(Evaluate, HolmCountsATestWithoutNumbersAsNotRejected) {
  const TestEntry test;
  TestWork without = judged(1e-9, 0.5, Verdict::error, test);
  without.outcome.channels.clear();
  EXPECT_THAT(adjusted({without, judged(0.03, 0.5, Verdict::pass, test)}),
              Pointwise(DoubleNear(1e-15), {0.06}));
}

TEST(Evaluate, HolmIsNotForTestsOutsideTheFamily) {
  const TestEntry test;
  TestWork outside = judged(0.03, 0.5, Verdict::pass, test);
  outside.outcome.place.inside = false;
  const double before = outside.outcome.channels[0].log_p_adjusted;
  EXPECT_THAT(adjusted({judged(1e-9, 1, Verdict::fail, test), outside}),
              Pointwise(DoubleNear(1e-15), {1e-9, std::exp(before)}));
}

// Its per cent is of no use to a claim that names none.
TEST(Evaluate, AnotherMeanOfZeroIsInvalidForItsMarginOnlyWhereThereIsOne) {
  const auto said = [](const std::string& more) {
    return run_test(R"(suite: nil
estimators:
  it: {plugin: analytic/normal}
  nil: {plugin: analytic/normal, deviation: 0}
tests: [{claim: mean(it) == mean(nil))" +
                    more + "}]\n")
        .message;
  };
  EXPECT_THAT(said(", detect: 1%"), HasSubstr("a margin in per cent"));
  EXPECT_THAT(said(""), testing::Not(HasSubstr("margin")));
}

std::string one_test(const std::string& estimator, const std::string& test) {
  return "suite: one\nestimators:\n  it: " + estimator +
         "\n  uniform: {plugin: analytic/exponential_uniform, primaries: 64}\ntests:\n  - {name: "
         "test, " +
         test + "}\n";
}

reports::Test judged_text(const std::string& estimator, const std::string& test) {
  return test_named(run_text(one_test(estimator, test)), "test");
}

TEST(Evaluate, HeavyTailIsOpenAndSaysHowManyWouldDo) {
  const reports::Test test = judged_text("{plugin: analytic/heavy_tail, primaries: 1}",
                                         "claim: mean(it) == analytic, secondaries: 100");
  EXPECT_EQ(test.verdict, Verdict::inconclusive);
  EXPECT_THAT(test.message, HasSubstr("`secondaries` would do"));
}

// A Pareto law of index 1.5 has no variance, but a lower bound: too much can be shown by bets, too
// little cannot.
TEST(Evaluate, TooMuchAboveALowerBoundIsBetOn) {
  const std::string heavy = "{plugin: analytic/heavy_tail, index: 1.5}";
  const reports::Test wrong = judged_text(heavy, "claim: mean(it) <= 2, test: betting");
  EXPECT_EQ(wrong.method, "betting");
  EXPECT_EQ(wrong.verdict, Verdict::fail);
  EXPECT_EQ(judged_text(heavy, "claim: mean(it) <= 4, test: betting").verdict, Verdict::pass);
  const reports::Test open =
      judged_text(heavy, "claim: mean(it) <= 4, detect: 50%, budget: 1e5, test: betting");
  EXPECT_EQ(open.verdict, Verdict::inconclusive);
  EXPECT_THAT(open.message, HasSubstr("declare the range"));
}

TEST(Evaluate, BinomialTestsQuoteTheirOwnPower) {
  const reports::Test test = judged_text("{plugin: analytic/dart_throwing, primaries: 1}",
                                         "claim: mean(it) == analytic, detect: 2%");
  EXPECT_EQ(test.method, "binomial");
  EXPECT_EQ(test.verdict, Verdict::pass);
  ASSERT_TRUE(test.power && test.detectable);
  EXPECT_GE(*test.power, 0.99);
  EXPECT_LE(*test.detectable, 0.02);
}

TEST(Evaluate, TwoObservationsAreJudgedInWords) {
  const reports::Test test = judged_text("{plugin: analytic/normal, primaries: 1}",
                                         "claim: mean(it) == 0, secondaries: 2");
  EXPECT_THAT(test.message, testing::Not(HasSubstr("_gate")));
  EXPECT_NE(test.verdict, Verdict::error);
}

TEST(Evaluate, ForcedMethodIsNotInvalidatedByItsGates) {
  const reports::Test test = judged_text("{plugin: analytic/heavy_tail, primaries: 1}",
                                         "claim: mean(it) == analytic, secondaries: 100, test: t");
  EXPECT_NE(test.verdict, Verdict::invalid);
  EXPECT_TRUE(std::any_of(test.gates.begin(), test.gates.end(),
                          [](const reports::Gate& gate) { return gate.state == "red"; }));
}

// Its range is that number but for rounding: nothing unseen can move its mean.
TEST(Evaluate, ZeroVarianceInADeclaredRangePassesAtItsFirstLook) {
  const reports::Test test =
      judged_text("{plugin: analytic/zero_variance}", "claim: mean(it) == analytic, detect: 0.5%");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_LE(test.samples[0].secondaries, 1000);
}

// Squares and fourth powers beyond doubles, above and below: a verdict on the test, not the end of
// the run.
TEST(Evaluate, SpreadsBeyondDoublesAreInvalid) {
  for (const char* scale : {"1e76", "1e140", "1e-80", "1e-170"}) {
    const std::string suite = fmt::format(
        "suite: s\nestimators:\n"
        "  x: {{plugin: analytic/law, law: exponential(1), scale: {0}}}\n"
        "  y: {{plugin: analytic/law, law: exponential(1), scale: {0}}}\n"
        "tests:\n"
        "  - {{claim: mean(x) == mean(y)}}\n"
        "  - {{claim: variance(x) == variance(y)}}\n"
        "  - {{claim: 'efficiency(x) == efficiency(y)', cost: samples}}\n",
        scale);
    const reports::Record record = run_text(suite);
    for (const reports::Test& test : record.suites[0].tests) {
      EXPECT_EQ(test.verdict, Verdict::invalid) << scale << " " << test.claim << test.message;
      EXPECT_THAT(test.message, testing::Not(HasSubstr("internal")));
    }
  }
}

TEST(Evaluate, ConstantHasNoVarianceToTest) {
  for (const char* claim : {"variance(it) == 3", "variance(it) < variance(uniform)",
                            "variance(uniform) > variance(it)"}) {
    const reports::Test test =
        judged_text("{plugin: analytic/zero_variance}", std::string("claim: ") + claim);
    EXPECT_EQ(test.verdict, Verdict::invalid) << claim;
    EXPECT_THAT(test.message, HasSubstr("without spread"));
  }
}

// 1000 secondaries of 64 see a spike of probability 1e-9 with probability 6e-5.
TEST(Evaluate, UnseenSpikeIsNoPassWhenSomethingMustBeExcluded) {
  EXPECT_EQ(judged_text("{plugin: analytic/rare_spike, probability: 1e-9}",
                        "claim: mean(it) == 0.5, detect: 1%")
                .verdict,
            Verdict::inconclusive);
  const std::string high = "{plugin: analytic/rare_spike, probability: 1e-9, height: 1e6}";
  const reports::Test missed = judged_text(high, "claim: mean(it) == 0.51");
  EXPECT_EQ(missed.verdict, Verdict::pass) << "a spike that makes up for it may be unseen";
}

TEST(Evaluate, ConstantIsComparedWithSpreadWhereItsRangeIsClosed) {
  const reports::Test test = judged_text("{plugin: analytic/zero_variance}",
                                         "claim: mean(uniform) == mean(it), detect: 5%");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_EQ(judged_text("{plugin: analytic/zero_variance}",
                        "claim: mean(it) == 1.2 * mean(uniform), detect: 5%")
                .verdict,
            Verdict::fail);
}

TEST(Evaluate, ConstantIsNotComparedWithSpreadWhereTheUnseenCouldDecide) {
  for (const char* claim : {"mean(it) == mean(uniform)", "mean(uniform) == mean(it)"}) {
    const reports::Test test = judged_text("{plugin: analytic/rare_spike, probability: 1e-9}",
                                           std::string("claim: ") + claim);
    EXPECT_EQ(test.verdict, Verdict::invalid) << claim;
    EXPECT_THAT(test.message, HasSubstr("never seen could move"));
  }
}

TEST(Evaluate, NotANumberIsAnErrorWithItsPlace) {
  const reports::Test test = judged_text(
      "{plugin: mutants/rare_nan, probability: 0.05, primaries: 1}", "claim: mean(it) == 0");
  EXPECT_EQ(test.verdict, Verdict::error);
  EXPECT_THAT(test.message, HasSubstr("not finite, the first is observation"));
  EXPECT_GT(test.samples[0].nonfinite, 0);
  EXPECT_FALSE(test.ok);
}

// The plan rests on sixth powers of what the pilot saw, values that are not numbers apart.
TEST(Evaluate, NotANumberInThePilotIsAnErrorToo) {
  const reports::Test test =
      judged_text("{plugin: mutants/rare_nan, probability: 0.05, primaries: 1}",
                  "claim: efficiency(it) >= 0.1, cost: samples");
  EXPECT_EQ(test.verdict, Verdict::error) << test.message;
  EXPECT_THAT(test.message, HasSubstr("not finite, the first is observation"));
}

TEST(Evaluate, MutantThatIsCaughtIsOk) {
  const reports::Test test = judged_text("{plugin: mutants/scaled, factor: 1.1}",
                                         "claim: mean(it) == analytic, detect: 5%, expect: fail");
  EXPECT_EQ(test.verdict, Verdict::fail);
  EXPECT_TRUE(test.ok);
}

TEST(Evaluate, MutantThatCannotActIsNeverActivatedAndNotOk) {
  for (const char* estimator :
       {"{plugin: mutants/scaled, factor: 1}",
        "{plugin: mutants/absolute_cosine, scene: triangle, primaries: 16}"}) {
    const reports::Test test =
        judged_text(estimator, "claim: mean(it) == 0.1, secondaries: 50, expect: fail, test: t");
    EXPECT_FALSE(test.ok) << estimator;
    EXPECT_EQ(test.message.rfind("never activated", 0), 0) << test.message;
  }
}

TEST(Evaluate, ExpectedInvalidIsOk) {
  const reports::Test test = judged_text("{plugin: analytic/normal, mean: 2, deviation: 0}",
                                         "claim: mean(it) == 3, secondaries: 100, expect: invalid");
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_TRUE(test.ok);
}

TEST(Evaluate, PassThatWasNotExpectedIsNotOk) {
  const reports::Test test = judged_text("{plugin: analytic/normal, mean: 2}",
                                         "claim: mean(it) == 2, expect: fail, secondaries: 50");
  EXPECT_EQ(test.verdict, Verdict::pass);
  EXPECT_FALSE(test.ok);
}

}  // namespace
}  // namespace assay::harness
