#include "harness/command/run.h"

#include "estimators/core/text_pattern.h"
#include "harness/record/output.h"
#include "reports/formats/json.h"
#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

constexpr const char* estimators = R"(suite: good
estimators:
  uniform: {plugin: analytic/exponential_uniform, primaries: 64}
  importance: {plugin: analytic/exponential_importance, primaries: 64}
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  area: {plugin: luminaire/area, scene: triangle, primaries: 64}
  hemisphere: {plugin: luminaire/hemisphere, scene: triangle, primaries: 64}
  no_cosine: {plugin: mutants/no_cosine, scene: triangle, primaries: 64}
tests:
)";

constexpr const char* tests = R"(  - {claim: mean(uniform) == analytic, detect: 2%}
  - {claim: mean(uniform) == mean(importance), detect: 2%}
  - {claim: variance(importance) < variance(uniform)}
  - {claim: variance(normal) == analytic, detect: 30%}
  - {claim: mean(area) == analytic, detect: 5%}
  - {claim: mean(area) == mean(hemisphere), detect: 10%}
  - {claim: mean(hemisphere) within 10% of analytic}
  - {claim: 'distribution(normal) == normal(2, 1)', detect: 0.1}
  - {claim: distribution(importance.x) == density}
  - {name: no cosine, claim: mean(no_cosine) == analytic, detect: 5%, expect: fail}
)";

using Runs = Placed;

// A row of a file by its line, a file of a command by its name.
TEST_F(Runs, ANumberThatIsNotFiniteIsNamedWithItsFile) {
  place.write("rows.txt", "# columns: a\n1\n\nnan\n2\n");
  place.write("render.sh", "echo nan >$3\n");
  const std::string suite =
      "suite: s\nestimators:\n  rows: {plugin: recorded, file: rows.txt}\n"
      "  made: {plugin: command, command: [sh, render.sh, '{seed}', '{samples}', '{out}'],\n"
      "         output: text, primaries: 1}\n"
      "tests:\n  - {claim: mean(rows) == 1}\n"
      "  - {claim: mean(made) == 1, secondaries: 8}\n";
  const reports::Record record = run_files({place.write("s.yaml", suite)});
  const auto& done = record.suites[0].tests;
  EXPECT_THAT(done[0].message, HasSubstr("the first is observation 1, `"));
  EXPECT_THAT(done[0].message, HasSubstr("rows.txt:4`"));
  EXPECT_THAT(done[1].message, HasSubstr("the first is observation 0, `"));
  EXPECT_THAT(done[1].message, HasSubstr(".txt`"));
}

std::string good() { return std::string(estimators) + tests; }

/// A test alone, without what belongs to the run (Holm, times, the file it stood in).
reports::Test raw(reports::Test test) {
  test.file.clear();
  test.replay.clear();
  test.line = 0;
  for (reports::Sample& sample : test.samples) sample.cost.seconds = 0;
  for (reports::Channel& channel : test.channels) {
    channel.p_adjusted.reset();
    channel.log10_p_adjusted.reset();
  }
  return test;
}

/// The numbers that rest on the sample alone, not on the test's share of the error rates.
void expect_same_sample(const reports::Test& one, const reports::Test& other) {
  ASSERT_EQ(one.samples.size(), other.samples.size()) << one.name;
  for (std::size_t i = 0; i < one.samples.size(); ++i) {
    EXPECT_EQ(raw(one).samples[i], raw(other).samples[i]) << one.name;
  }
  ASSERT_EQ(one.channels.size(), other.channels.size()) << one.name;
  for (std::size_t i = 0; i < one.channels.size(); ++i) {
    EXPECT_EQ(one.channels[i].statistic, other.channels[i].statistic) << one.name;
    EXPECT_EQ(one.channels[i].log10_p, other.channels[i].log10_p) << one.name;
  }
}

TEST_F(Runs, OfAGoodSuiteIsGood) {
  const reports::Record record = run_text(good());
  for (const reports::Test& test : record.suites[0].tests) {
    EXPECT_TRUE(test.ok) << test.name << ": " << test.message;
  }
  EXPECT_EQ(test_named(record, "no cosine").verdict, Verdict::fail);
  EXPECT_EQ(exit_code(record, InconclusivePolicy::report), 0);
}

TEST_F(Runs, HasTheSameBitsOnEveryNumberOfThreads) {
  const std::string file = place.write("suite.yaml", good());
  const std::string one = numbers_of(run_files({file}, {.threads = 1}));
  EXPECT_EQ(numbers_of(run_files({file}, {.threads = 2})), one);
  EXPECT_EQ(numbers_of(run_files({file}, {.threads = 5})), one);
}

TEST_F(Runs, UnderAFilterKeepsEveryRemainingTestsNumbers) {
  const std::string file = place.write("suite.yaml", good());
  const reports::Record whole = run_files({file});
  for (const char* filter : {"*mean(area)*", "*distribution*", "*/no cosine", "*variance*"}) {
    const reports::Record part = run_files({file}, {.selection = {.filters = {filter}}});
    ASSERT_FALSE(part.suites[0].tests.empty()) << filter;
    ASSERT_LT(part.suites[0].tests.size(), whole.suites[0].tests.size()) << filter;
    EXPECT_THAT(part.note, HasSubstr("not every test"));
    for (const reports::Test& test : part.suites[0].tests) {
      EXPECT_EQ(raw(test), raw(test_named(whole, test.name))) << test.name;
      for (const reports::Channel& channel : test.channels) EXPECT_FALSE(channel.p_adjusted);
    }
  }
}

TEST_F(Runs, InShardsIsTheWholeInParts) {
  const std::string file = place.write("suite.yaml", good());
  const reports::Record whole = run_files({file});
  std::size_t seen = 0;
  for (unsigned shard = 1; shard <= 3; ++shard) {
    const reports::Record part = run_files({file}, {.shard = std::pair(shard, 3U)});
    for (const reports::Test& test : part.suites[0].tests) {
      EXPECT_EQ(raw(test), raw(test_named(whole, test.name))) << test.name;
      ++seen;
    }
  }
  EXPECT_EQ(seen, whole.suites[0].tests.size());
}

// A mutant has the stream of its original, and draws it by itself.
TEST_F(Runs, InShardsDealsAMutantApartFromItsOriginal) {
  const std::string file = place.write("suite.yaml", R"(suite: two
estimators:
  sound: {plugin: luminaire/area, scene: triangle, primaries: 64}
  broken: {plugin: mutants/no_cosine, scene: triangle, primaries: 64}
tests:
  - {claim: mean(sound) == analytic, secondaries: 1000}
  - {claim: mean(broken) == analytic, secondaries: 1000, expect: fail}
)");
  for (unsigned shard = 1; shard <= 2; ++shard) {
    const reports::Record part = run_files({file}, {.shard = std::pair(shard, 2U)});
    EXPECT_EQ(part.suites[0].tests.size(), 1U);
  }
}

// Without margins n does not depend on the share of alpha either.
TEST_F(Runs, KeepsATestsNumbersWhenOthersAreAdded) {
  const std::string few =
      "  - {claim: mean(uniform) == analytic}\n"
      "  - {claim: variance(normal) == analytic}\n";
  const std::string more =
      "  - {claim: mean(uniform) <= 7, secondaries: 30000}\n" + few +
      "  - {claim: \"distribution(normal) == normal(2, 1)\", secondaries: 20000}\n"
      "  - {claim: variance(importance) < variance(uniform)}\n";
  const reports::Record one = run_text(estimators + few);
  const reports::Record other = run_text(estimators + more);
  for (const reports::Test& test : one.suites[0].tests) {
    expect_same_sample(test, test_named(other, test.name));
  }
}

TEST_F(Runs, KeepsATestsNumbersWhenASuiteIsRunBesideIt) {
  const std::string one = place.write("one.yaml", good());
  const std::string two = place.write("two.yaml", good() + "  - {claim: mean(uniform) <= 7}\n");
  const reports::Record alone = run_files({one});
  const reports::Record both = run_files({two, one});
  for (std::size_t i = 0; i < alone.suites[0].tests.size(); ++i) {
    EXPECT_EQ(raw(both.suites[1].tests[i]), raw(alone.suites[0].tests[i]));
  }
}

// Both name `data.txt`, each beside itself: the numbers of one are not those of the other.
TEST_F(Runs, KeepsFilesOfOneNameInTwoFoldersApart) {
  const std::string text =
      "suite: data\nestimators:\n  data: {plugin: recorded, file: data.txt}\n"
      "tests:\n  - {claim: mean(data) == 2}\n";
  for (const char* folder : {"one", "two"}) std::filesystem::create_directory(place.file(folder));
  place.write("one/data.txt", "1\n2\n3\n");
  place.write("two/data.txt", "11\n12\n13\n14\n");
  const reports::Record record = run_files(
      {place.write("one/suite.yaml", text), place.write("two/suite.yaml", text)}, {.threads = 1});
  EXPECT_EQ(record.suites[0].tests[0].samples[0].mean, 2);
  EXPECT_EQ(record.suites[1].tests[0].samples[0].mean, 12.5);
  EXPECT_EQ(record.suites[1].tests[0].samples[0].secondaries, 4);
}

std::string refused(const std::string& test, const RunOptions& options = {}) {
  return refusal([&] { run_text(estimators + test, options); });
}

TEST_F(Runs, RefusesToCoarsenDetectBelowWhatIsAllowed) {
  const std::string test = "  - {claim: mean(normal) == 2, allow: 1%, detect: 4%}\n";
  const char* const words = "brings `detect` down to `allow`";
  EXPECT_THAT(refused(test, {.coarsen = 0.2}), HasSubstr(words));
  EXPECT_THAT(refused(test, {.coarsen = 0.25}), HasSubstr(words));
  EXPECT_EQ(refused(test, {.coarsen = 0.75}), "(nothing was refused)");
}

TEST_F(Runs, RefusesADetectThatWouldTakeDaysAndSaysHowMuch) {
  const std::string text = refused("  - {claim: mean(normal) == 2, detect: 1e-7}\n");
  const std::string words = "this claim would take about ";
  ASSERT_NE(text.find(words), std::string::npos) << text;
  const double primaries = std::stod(text.substr(text.find(words) + words.size()));
  // (z_.005 + z_.01)^2 / 1e-14 = 2.403e15, printed to two digits; the pilot knows the variance to a
  // tenth.
  EXPECT_GE(primaries, 2.35e15);
  EXPECT_LE(primaries, 2.403e15 * 1.12);
  EXPECT_EQ(refused("  - {claim: mean(normal) == 2, detect: 1e-7, budget: 2000}\n"),
            "(nothing was refused)");
}

// A quarter and three quarters of 40000 primaries, whichever tests run.
TEST_F(Runs, SplitsTheSuitesBudgetByWeight) {
  const std::string text =
      "suite: budget\nbudget: 40000\nestimators:\n"
      "  normal: {plugin: analytic/normal, primaries: 1}\ntests:\n"
      "  - {name: one, claim: mean(normal) == 0, detect: 0.001}\n"
      "  - {name: two, claim: mean(normal) <= 0, detect: 0.001, weight: 3}\n";
  const reports::Record both = run_text(text);
  EXPECT_EQ(test_named(both, "one").samples[0].secondaries, 10000);
  EXPECT_EQ(test_named(both, "two").samples[0].secondaries, 30000);
  const reports::Record alone = run_text(text, {.selection = {.filters = {"*/one"}}});
  EXPECT_EQ(raw(alone.suites[0].tests[0]), raw(both.suites[0].tests[0]));
  EXPECT_FALSE(both.suites[0].timed);
}

TEST_F(Runs, StopsWhereTheSuitesSecondsAreSpent) {
  const reports::Record record = run_text(
      "suite: budget\nbudget: 0.001s\nestimators:\n  normal: {plugin: analytic/normal, primaries: "
      "1}\ntests:\n  - {name: one, claim: mean(normal) == 0, detect: 0.001}\n");
  const reports::Test& test = test_named(record, "one");
  EXPECT_EQ(test.verdict, reports::Verdict::inconclusive);
  EXPECT_THAT(test.message, HasSubstr("its budget in seconds ended here"));
  EXPECT_TRUE(record.suites[0].timed);
}

TEST_F(Runs, SeedsChangeTheNumbers) {
  const reports::Record one = run_text(good(), {.seed = 1});
  const reports::Record two = run_text(good(), {.seed = 2});
  EXPECT_EQ(one.seed, 1);
  EXPECT_EQ(two.seed, 2);
  for (const reports::Test& test : one.suites[0].tests) {
    const reports::Test& other = test_named(two, test.name);
    EXPECT_NE(test.channels[0].statistic, other.channels[0].statistic) << test.name;
  }
}

TEST_F(Runs, TakesTheSuitesSeedUnlessGivenAnother) {
  const std::string seeded = "seed: 7\n" + good();
  EXPECT_EQ(run_text(seeded).suites[0].seed, 7);
  EXPECT_EQ(run_text(seeded, {.seed = 3}).suites[0].seed, 3);
  EXPECT_EQ(run_text(good()).suites[0].seed, 1);
}

TEST_F(Runs, AlphaAndCoarsenReplaceTheSuites) {
  const reports::Record record = run_text(good(), {.alpha = 0.05, .coarsen = 2});
  EXPECT_EQ(record.suites[0].alpha, 0.05);
  EXPECT_DOUBLE_EQ(*test_named(record, "mean(uniform) == analytic").detect, 0.04);
}

TEST_F(Runs, RefusesBeforeAnythingIsSampled) {
  struct Counter final : Progress {
    int phases = 0;
    void begin(const Phase&) override { ++phases; }
    void advance(std::uint64_t) override {}
    void end() override {}
  } counter;
  const Suite suite = load_suite(place.write(
      "suite.yaml", good() + "  - {claim: variance(normal) == 1, name: bad, test: welch}\n"));
  EXPECT_THROW(run({suite}, {}, counter), InputError);
  EXPECT_EQ(counter.phases, 0);
}

reports::Test outcome_of(Verdict verdict, Verdict expected = Verdict::pass) {
  reports::Test test;
  test.verdict = verdict;
  test.expected = expected;
  test.ok = verdict == expected;
  return test;
}

int code(std::vector<reports::Test> all, InconclusivePolicy policy = InconclusivePolicy::report) {
  reports::Suite suite;
  suite.tests = std::move(all);
  reports::Record record;
  record.suites = {std::move(suite)};
  return exit_code(record, policy);
}

TEST_F(Runs, ExitCodesMeanWhatTheyMean) {
  const reports::Test pass = outcome_of(Verdict::pass);
  EXPECT_EQ(code({pass, outcome_of(Verdict::fail, Verdict::fail)}), 0);
  for (const Verdict bad : {Verdict::fail, Verdict::invalid, Verdict::error}) {
    EXPECT_EQ(code({pass, outcome_of(bad)}), 1);
    EXPECT_EQ(code({outcome_of(Verdict::inconclusive), outcome_of(bad)}), 1);
  }
  EXPECT_EQ(code({outcome_of(Verdict::pass, Verdict::fail)}), 1);
  EXPECT_EQ(code({outcome_of(Verdict::invalid, Verdict::invalid)}), 0);
  EXPECT_EQ(code({pass, outcome_of(Verdict::inconclusive)}), 3);
  EXPECT_EQ(code({}), 4);
  EXPECT_EQ(code({outcome_of(Verdict::skipped), outcome_of(Verdict::skipped)}), 77);
}

TEST_F(Runs, InconclusiveIsJudgedAsAsked) {
  const reports::Test undecided = outcome_of(Verdict::inconclusive);
  EXPECT_EQ(code({undecided}, InconclusivePolicy::fail), 1);
  EXPECT_EQ(code({undecided}, InconclusivePolicy::pass), 0);
}

// The p-value of such variances is no double any more.
TEST_F(Runs, ComparesEstimatorsByLogarithmsThatDoNotUnderflow) {
  const reports::Record record = run_text(R"(suite: s
estimators:
  narrow: {plugin: analytic/normal, primaries: 1}
  wide: {plugin: analytic/normal, deviation: 1000000, primaries: 1}
tests:
  - {claim: mean(narrow) == mean(wide), secondaries: 10000}
)");
  ASSERT_EQ(record.suites[0].comparisons.size(), 1u);
  const reports::Comparison& pair = record.suites[0].comparisons[0];
  EXPECT_LT(*pair.log10_variance_p, -400);
  EXPECT_NEAR(*pair.log10_mean_p, std::log10(*pair.mean_p), 1e-9);
}

TEST_F(Runs, GlobsMatchTheWholeId) {
  EXPECT_TRUE(matches("*", "suite/test"));
  EXPECT_TRUE(matches("suite/*", "suite/a test"));
  EXPECT_TRUE(matches("s?ite/*test", "suite/a test"));
  EXPECT_FALSE(matches("suite", "suite/test"));
  EXPECT_FALSE(matches("*/tes", "suite/test"));
  EXPECT_TRUE(matches("*mean(a)*", "suite/mean(a) == 1"));
}

}  // namespace
}  // namespace assay::harness
