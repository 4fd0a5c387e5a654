#include "harness/command/commands.h"
#include "harness/plan/plan.h"
#include "harness/run/planned_run.h"
#include "reports/words/number.h"
#include "reports/words/text.h"
#include "tests/harness/prelude.h"
#include "tests/harness/recorded_rows.h"

namespace assay::harness {
namespace {

constexpr const char* planned_suite = R"(suite: planned
estimators:
  uniform: {plugin: analytic/exponential_uniform}
  normal: {plugin: analytic/normal, mean: 2, primaries: 4}
  area: {plugin: luminaire/area, scene: triangle}
tests:
  - {claim: mean(area) == analytic, detect: 0.5%}
  - {claim: mean(area) == analytic, name: coarser, detect: 2%}
  - {claim: mean(uniform) == analytic}
  - {claim: mean(normal) == 2, secondaries: 500}
  - {claim: variance(normal) == analytic, detect: 10%}
  - {claim: 'distribution(normal) == normal(2, 0.5)', detect: 0.05}
  - {claim: distribution(area.point.v) == density, detect: 0.05}
)";

PlannedRun planned_of(const std::vector<Suite>& suites, const RunOptions& options = {}) {
  return plan_run(suites, options, silence);
}

class PlanTable : public Placed {
 protected:
  std::vector<Suite> suites_of(const std::string& text = planned_suite) const {
    return {load_suite(place.write("planned.yaml", text))};
  }
  /// The plan for these lines of tests of a normal law.
  PlannedRun planned(const std::string& tests, const RunOptions& options = {}) const {
    return planned_of(suites_of("suite: normal\nestimators:\n"
                                "  normal: {plugin: analytic/normal, mean: 2, primaries: 1}\n"
                                "  darts: {plugin: analytic/dart_throwing}\n"
                                "tests:\n" +
                                tests),
                      options);
  }
};
using Forecasts = PlanTable;

TEST_F(PlanTable, PlansWhatARunThenDoes) {
  const std::vector<Suite> suites = suites_of();
  const PlannedRun planned = planned_of(suites);
  const reports::Record record = run(suites, {}, silence);
  ASSERT_EQ(planned.suites[0]->tests.size(), record.suites[0].tests.size());
  for (std::size_t i = 0; i < record.suites[0].tests.size(); ++i) {
    const reports::Test& test = record.suites[0].tests[i];
    const Plan& plan = planned.suites[0]->tests[i].outcome.plan;
    EXPECT_EQ(plan.method.name, test.method) << test.name;
    EXPECT_EQ(plan.primaries[0], test.samples[0].primaries) << test.name;
    EXPECT_EQ(plan.looks.sizes, test.planned_looks) << test.name;
    ASSERT_LE(test.looks.size(), plan.looks.count()) << test.name;
    for (std::size_t k = 0; k < test.looks.size(); ++k) {
      EXPECT_EQ(plan.looks.sizes[k], test.looks[k].secondaries) << test.name;
      EXPECT_EQ(plan.looks.alpha[k], test.looks[k].alpha) << test.name;
      EXPECT_EQ(plan.looks.beta[k], test.looks[k].beta) << test.name;
    }
  }
}

TEST_F(PlanTable, DrawsNoObservationOfATest) {
  const std::vector<Suite> suites = suites_of();
  const PlannedRun planned = planned_of(suites);
  EXPECT_FALSE(plan_text(planned).empty());
  for (const auto& pool : planned.pools.all()) EXPECT_EQ(pool->drawn(), 0U);
}

// Counted rays do not depend on the machine: one shadow ray a primary.
TEST_F(PlanTable, CountsRaysAndSecondsAtThePlannedPrimaries) {
  const PlannedRun planned = planned_of(suites_of());
  const TestOutcome& area = planned.suites[0]->tests[0].outcome;
  const std::uint64_t primaries = area.plan.primaries[0];
  ASSERT_GT(primaries, 1U);
  const auto cost =
      observation_cost(area.question.subjects[0], primaries, planned.suites[0]->pilots);
  EXPECT_DOUBLE_EQ(cost.value().rays, static_cast<double>(primaries));
  EXPECT_DOUBLE_EQ(cost->samples, static_cast<double>(primaries));
  EXPECT_GT(cost->seconds, 0);
  const Question& draws = planned.suites[0]->tests[6].outcome.question;
  const auto of_draw = observation_cost(draws.subjects[0], 1, planned.suites[0]->pilots);
  EXPECT_EQ(of_draw.value().rays, 0);
  EXPECT_GT(of_draw->seconds, 0);
}

// Postponed looks too.
TEST_F(PlanTable, SaysTheMostThatCanBeDrawn) {
  const PlannedRun planned = planned_of(suites_of());
  double most = 0;
  for (const auto& pool : planned.pools.all()) {
    most += static_cast<double>(pool->most_marked() *
                                primaries_of_observation(*pool->setup(), pool->primaries()));
  }
  std::string text = plan_text(planned);
  std::ranges::replace(text, '\n', ' ');
  const auto count = static_cast<std::uint64_t>(std::llround(most));
  EXPECT_THAT(text, HasSubstr("may raise this to " +
                              reports::plain_spaces(reports::count_text(count)) + " primaries"));
}

// A plan foretells the effect that a fixed number of observations finds, and the run finds it in
// its data. Pilots of 8192 primaries give the spreads of logarithms, so both agree to a tenth. A
// forgotten second source would make them differ by the square root of two. Rows are all there.
TEST_F(PlanTable, ForetellsTheEffectThatTheDataFind) {
  place.write("rows.txt", file_of("lognormal(0.5, 2000, 5)"));
  const std::string text =
      "suite: ratios\nestimators:\n  a: {plugin: luminaire/area, scene: triangle}\n"
      "  h: {plugin: luminaire/hemisphere, scene: triangle}\n"
      "  r: {plugin: recorded, file: rows.txt}\ntests:\n"
      "  - {claim: mean(r) == 1.13, detect: 0.1%}\n"
      "  - {claim: variance(r) <= variance(a)}\n"
      "  - {claim: efficiency(a) > efficiency(h), secondaries: 4000}\n"
      "  - {claim: efficiency(a) == 14, secondaries: 4000}\n"
      "  - {claim: total_variance(a) <= total_variance(h), secondaries: 4000}\n"
      "  - {claim: variance(a) <= variance(h), secondaries: 4000}\n"
      "  - {claim: cost(a) == cost(h), secondaries: 4000}\n";
  const std::vector<Suite> suites = suites_of(text);
  const PlannedRun planned = planned_of(suites);
  const reports::Record record = run(suites, {}, silence);
  for (std::size_t i = 0; i < record.suites[0].tests.size(); ++i) {
    const reports::Test& test = record.suites[0].tests[i];
    const TestOutcome& outcome = planned.suites[0]->tests[i].outcome;
    const auto foretold = forecast(outcome, planned.suites[0]->pilots).detectable;
    ASSERT_EQ(foretold.has_value(), test.detectable.has_value()) << test.name;
    if (!foretold) continue;
    EXPECT_NEAR(*foretold / *test.detectable, 1, 0.1) << test.name;
  }
}

// 500 means of four normal values of deviation 1, with alpha and beta .05. Both one-sided tests
// reject where the margin is (1.645 + 1.960) .5 / sqrt 500. A pilot of 2048 gives the deviation.
TEST_F(PlanTable, OfAMarginForetellsTheOneThatABudgetShows) {
  const std::string text =
      "suite: margins\nalpha: 0.05\nbeta: 0.05\nestimators:\n"
      "  normal: {plugin: analytic/normal, mean: 2, primaries: 4}\n"
      "  wide: {plugin: analytic/dart_throwing}\ntests:\n"
      "  - {claim: mean(normal) within 0.001 of 2, secondaries: 500}\n"
      "  - {claim: mean(normal) within 50% of 2, name: beyond, secondaries: 500}\n"
      "  - {claim: mean(wide) within 1% of analytic, test: betting, secondaries: 500}\n";
  const PlannedRun planned = planned_of(suites_of(text));
  const auto shown = [&](std::size_t i) {
    return forecast(planned.suites[0]->tests[i].outcome, planned.suites[0]->pilots).detectable;
  };
  EXPECT_NEAR(shown(0).value(), 3.605 * .5 / std::sqrt(500), .004);
  EXPECT_NEAR(shown(1).value(), shown(0).value() / 2, 1e-4) << "of 2";
  EXPECT_FALSE(shown(2).has_value()) << "betting, of which no formula tells";
}

// Pilots take 144 primaries. Three more in [0, 4] find no difference that the range allows, so
// `detect` does not answer what the last look finds.
TEST_F(PlanTable, ShowsNoEffectThatTheBudgetDoesNotFind) {
  const std::string text = plan_text(
      planned("  - {claim: mean(darts) == analytic, test: betting, detect: 1%, budget: 147}\n"));
  const std::size_t row = text.find("by betting\n") + 11;
  ASSERT_GT(row, 11U) << text;
  EXPECT_THAT(text.substr(row, text.find('\n', row) - row), testing::Not(HasSubstr("%"))) << text;
}

TEST_F(PlanTable, ShowsEveryTestInEightyColumns) {
  const std::vector<Suite> suites = suites_of();
  const PlannedRun planned = planned_of(suites);
  const std::string text = plan_text(planned);
  for (const TestEntry& test : suites[0].tests) EXPECT_THAT(text, HasSubstr("\n  " + test.name));
  for (const char* heading : {"by t", "primaries", "looks", "CPU time", "effect",
                              "if it holds: pass", "if off by `detect`: pass"}) {
    EXPECT_THAT(text, HasSubstr(heading));
  }
  EXPECT_THAT(text, HasSubstr("0.5 %"));
  EXPECT_THAT(text, testing::Not(HasSubstr("green"))) << "that is no news";
  EXPECT_THAT(text, HasSubstr("share observations"));
  for (const std::string& line : lines(text)) EXPECT_LE(reports::columns(line), 80) << line;
  EXPECT_EQ(plan_exit_code(planned), 0);
}

TEST_F(PlanTable, APlanWithoutAValidMethodIsNotOk) {
  place.write("rows.txt", "1\n3\n2\n5\n4\n");
  const std::vector<Suite> suites = suites_of(R"(suite: few
estimators:
  rows: {plugin: recorded, file: rows.txt}
tests:
  - {claim: mean(rows) <= 1, detect: 50%}
)");
  const PlannedRun planned = planned_of(suites);
  EXPECT_EQ(plan_exit_code(planned), 1);
  EXPECT_THAT(plan_text(planned), HasSubstr("invalid: "));
}

// Data are normal, and theta is 0 or `detect`. A part drawn lies in (0, 1], so the mean of 40 seeds
// has a standard error below 0.05, and is off by four of them with probability 6e-5.
TEST_F(Forecasts, TellsTheErrorsAndWhatIsDrawn) {
  const std::vector<Suite> suites = suites_of(R"(suite: share
alpha: 0.02
estimators:
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
tests:
  - {name: true, claim: mean(normal) == 2, detect: 0.3%}
  - {name: off, claim: mean(normal) == 2.006, detect: 0.006}
)");
  std::array<double, 2> foretold{};
  std::array<double, 2> drawn{};
  constexpr int seeds = 40;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    PlannedRun planned = planned_of(suites, {.seed = seed});
    std::vector<TestWork*> works;
    for (TestWork& work : planned.suites[0]->tests) {
      const Forecast found = forecast(work.outcome, planned.suites[0]->pilots);
      EXPECT_GE(found.if_true->fail, 0.0085);
      EXPECT_LE(found.if_true->fail, 0.01 + 1e-6);
      EXPECT_GE(found.if_off->pass, 0.005) << "the pilot's upper limit of the variance leaves room";
      EXPECT_LE(found.if_off->pass, 0.01 + 1e-6);
      EXPECT_LT(found.if_true->inconclusive, 0.001);
      EXPECT_NEAR(found.if_off->pass + found.if_off->fail + found.if_off->inconclusive, 1, 1e-12);
      const std::size_t which = works.size();
      foretold[which] += (which == 0 ? found.if_true : found.if_off)->drawn / seeds;
      works.push_back(&work);
    }
    sample_in_looks(works, planned.pools.all(), {.executor = threads(1)}, silence);
    for (std::size_t i = 0; i < works.size(); ++i) {
      drawn[i] += static_cast<double>(works[i]->outcome.secondaries()) /
                  static_cast<double>(works[i]->outcome.plan.most_secondaries()) / seeds;
    }
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) EXPECT_NEAR(drawn[i], foretold[i], 0.2);
}

TEST_F(Forecasts, OfProofsHoldsByTheAdvantageOrStandsAtTheBorder) {
  const PlannedRun proofs = planned(
      "  - {name: less, claim: mean(normal) < 3, detect: 0.01}\n"
      "  - {name: within, claim: mean(normal) within 0.01 of 2}\n");
  for (const TestWork& work : proofs.suites[0]->tests) {
    const Forecast found = forecast(work.outcome, proofs.suites[0]->pilots);
    EXPECT_GE(found.if_true->pass, 0.99) << work.outcome.question.test->name;
    EXPECT_GE(found.if_off->pass, 0.008) << work.outcome.question.test->name;
    EXPECT_LE(found.if_off->pass, 0.01 + 1e-6) << work.outcome.question.test->name;
  }
}

TEST_F(PlanTable, BoundsTheProbabilityThatASuiteIsNotOk) {
  EXPECT_THAT(plan_text(planned("  - {name: a, claim: mean(normal) == 2, detect: 0.01}\n"
                                "  - {name: b, claim: mean(normal) <= 2, detect: 0.01}\n")),
              HasSubstr("some claim fails or stays undecided with\nprobability about 0.9"));
}

TEST_F(PlanTable, SaysWhereTheDetectOfALawIsTheDefault) {
  const std::string law = "  - {claim: 'distribution(normal) == normal(2, 1)'}\n";
  EXPECT_THAT(plan_text(planned(law)),
              HasSubstr("      `detect` is 0.05, the default for claims about laws\n"));
  EXPECT_THAT(plan_text(planned(law, {.coarsen = 2})), HasSubstr("`detect` is 0.1, the default"));
}

// Coarsened, a margin may be larger than its reference: nobody wrote it so.
TEST_F(PlanTable, TakesACoarsenedMarginBeyondItsReference) {
  const PlannedRun coarse =
      planned("  - {claim: mean(normal) == 2, detect: 1.5}\n", {.coarsen = 4});
  EXPECT_EQ(coarse.suites[0]->tests[0].outcome.plan.regions[0].detect, 6);
  const PlannedRun pair =
      planned("  - {claim: mean(normal) == mean(normal), detect: 1.5}\n", {.coarsen = 4});
  EXPECT_TRUE(pair.suites[0]->tests[0].outcome.plan.invalid.empty());
}

}  // namespace
}  // namespace assay::harness
