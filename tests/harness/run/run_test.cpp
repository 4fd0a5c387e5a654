#include "harness/command/commands.h"
#include "harness/record/record_of.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

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
  EXPECT_THAT(done[0].message, HasSubstr("the first is `"));
  EXPECT_THAT(done[0].message, HasSubstr("rows.txt:4`"));
  EXPECT_THAT(done[1].message, HasSubstr("the first is observation 0, `"));
  EXPECT_THAT(done[1].message, HasSubstr(".txt`"));
}

/// The estimators of good.yaml with these tests.
std::string suite_of(const std::string& tests) {
  return good_suite().substr(0, good_suite().find("tests:\n") + 7) + tests;
}

TEST_F(Runs, OfAGoodSuiteIsGoodAndHasTheSameBitsOnEveryNumberOfThreads) {
  const std::string file = place.write("suite.yaml", good_suite());
  const reports::Record record = run_files({file}, {.threads = 1});
  for (const reports::Test& test : record.suites[0].tests) {
    EXPECT_TRUE(test.ok) << test.name << ": " << test.message;
  }
  EXPECT_EQ(test_named(record, "no cosine").verdict, Verdict::fail);
  EXPECT_EQ(exit_code(record, InconclusivePolicy::report), 0);
  const std::string one = numbers_of(record);
  EXPECT_EQ(numbers_of(run_files({file}, {.threads = 2})), one);
  EXPECT_EQ(numbers_of(run_files({file}, {.threads = 5})), one);
}

TEST_F(Runs, UnderAFilterKeepsEveryRemainingTestsNumbers) {
  const std::string file = place.write("suite.yaml", good_suite());
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
  const reports::Record one = run_text(suite_of(few));
  const reports::Record other = run_text(suite_of(more));
  for (const reports::Test& test : one.suites[0].tests) {
    const reports::Test& same = test_named(other, test.name);
    EXPECT_EQ(raw(test).samples, raw(same).samples) << test.name;
    EXPECT_EQ(test.channels[0].statistic, same.channels[0].statistic) << test.name;
    EXPECT_EQ(test.channels[0].log10_p, same.channels[0].log10_p) << test.name;
  }
}

TEST_F(Runs, KeepsATestsNumbersWhenASuiteIsRunBesideIt) {
  const std::string one = place.write("one.yaml", good_suite());
  const std::string two = place.write("two.yaml", good_suite("  - {claim: mean(uniform) <= 7}\n"));
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
  return refusal([&] { run_text(suite_of(test), options); });
}

TEST_F(Runs, RefusesToCoarsenDetectBelowWhatIsAllowed) {
  const std::string test = "  - {claim: mean(normal) == 2, allow: 1%, detect: 4%}\n";
  const char* const words = "brings `detect` down to `allow`";
  EXPECT_THAT(refused(test, {.coarsen = 0.2}), HasSubstr(words));
  EXPECT_THAT(refused(test, {.coarsen = 0.25}), HasSubstr(words));
  EXPECT_EQ(refused(test, {.coarsen = 0.75}), "(nothing was refused)");
}

TEST_F(Runs, CoarsensDistancesOfLawsToAHalfAtMost) {
  const std::string test = "  - {claim: 'distribution(normal) == normal(2, 1)', detect: @}\n";
  const auto coarsened = [&](const std::string& detect) {
    std::string text = suite_of(test);
    text.replace(text.find('@'), 1, detect);
    const reports::Record record = run_text(text, {.coarsen = 30});
    return record.suites[0].tests[0].detect;
  };
  EXPECT_EQ(coarsened("0.01"), 0.3);
  EXPECT_EQ(coarsened("0.2"), 0.5);
  EXPECT_EQ(coarsened("0.7"), 0.7);
}

TEST_F(Runs, SaysHowMuchADetectWouldTakeThatTakesDays) {
  const auto run = [](const std::string& margin) {
    const std::string test = "  - {claim: mean(normal) == 2, detect: " + margin + "}\n";
    return run_text(suite_of(test)).suites[0].tests[0];
  };
  const reports::Test days = run("1e-7");
  EXPECT_EQ(days.verdict, reports::Verdict::error);
  const std::string words = "this claim would take about ";
  ASSERT_NE(days.message.find(words), std::string::npos) << days.message;
  const double primaries = std::stod(days.message.substr(days.message.find(words) + words.size()));
  // (z_.005 + z_.01)^2 / 1e-14 = 2.403e15, printed to two digits. A pilot of 8192 knows the
  // variance with a deviation of 1.6 %.
  EXPECT_NEAR(primaries, 2.403e15, 2.403e15 * 4 * 0.016);
  EXPECT_EQ(run("1e-7, budget: 2000").verdict, reports::Verdict::inconclusive);
  EXPECT_EQ(run("0.1}\n  - {claim: mean(normal) <= 2, detect: 1e-7").verdict,
            reports::Verdict::pass);
}

// The mean is 2. Off by 2.45 standard errors, the interval at 1 - 2 beta often misses the claim.
TEST_F(Runs, ShowsOfAnUndecidedClaimAnIntervalThatMeetsClaimAndMargin) {
  int undecided = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const reports::Record record =
        run_text(suite_of("  - {claim: mean(normal) == 1.9, detect: 0.15, secondaries: 600}\n"),
                 {.seed = seed});
    const reports::Test& test = record.suites[0].tests[0];
    if (test.verdict != Verdict::inconclusive) continue;
    ++undecided;
    EXPECT_LE(*test.channels[0].effect.low, 0) << seed;
    EXPECT_GE(*test.channels[0].effect.high, 0.15) << seed;
  }
  EXPECT_GE(undecided, 20);
}

// A quarter and three quarters of 40000 primaries, whichever tests run. The pilot may take a
// twelfth of the larger share, of which the smaller share pays a twelfth of its own.
TEST_F(Runs, SplitsTheSuitesBudgetByWeight) {
  const std::string text =
      "suite: budget\nbudget: 40000\nestimators:\n"
      "  normal: {plugin: analytic/normal, primaries: 1}\ntests:\n"
      "  - {name: one, claim: mean(normal) == 0, detect: 0.001}\n"
      "  - {name: two, claim: mean(normal) <= 0, detect: 0.001, weight: 3}\n";
  const reports::Record both = run_text(text);
  EXPECT_EQ(test_named(both, "one").samples[0].secondaries, 10000 - 833);
  EXPECT_EQ(test_named(both, "two").samples[0].secondaries, 30000 - 2500);
  const reports::Record alone = run_text(text, {.selection = {.filters = {"*/one"}}});
  EXPECT_EQ(raw(alone.suites[0].tests[0]), raw(both.suites[0].tests[0]));
  EXPECT_FALSE(both.suites[0].timed);
  // A budget of the test's own would not help.
  EXPECT_THAT(test_named(both, "one").advice.value().words,
              testing::MatchesRegex("give the suite [0-9.]+ times its `budget`"));
}

TEST_F(Runs, StopsWhereTheSuitesSecondsAreSpent) {
  const reports::Record record = run_text(
      "suite: budget\nbudget: 0.001s\nestimators:\n  normal: {plugin: analytic/normal, primaries: "
      "1}\ntests:\n  - {name: one, claim: mean(normal) == 0, detect: 0.001}\n");
  const reports::Test& test = test_named(record, "one");
  expect_said(test, reports::Verdict::inconclusive, {"its budget in seconds ended here"});
  EXPECT_TRUE(record.suites[0].timed);
}

TEST_F(Runs, EveryTestHasALineThatReplaysIt) {
  const std::string file = place.write("suite.yaml", good_suite());
  const std::string other = place.write("other.yaml", good_suite());
  const auto replayed = [&](bool assigns) {
    const RunOptions options{.seed = 9, .command = "assay run --coarsen 2", .assigns = assigns};
    return run_files({file, other}, options).suites[0].tests[1].replay;
  };
  const std::string rest =
      " --coarsen 2 --seed 9 --filter 'suite/mean(uniform) == mean(importance)'";
  EXPECT_EQ(replayed(false), "assay run " + file + rest);
  // The parameter that is set may be another suite's.
  EXPECT_EQ(replayed(true), "assay run " + file + " " + other + rest);
}

// Some pilots miss the rare value, and plan looks that see too little of it. A larger one follows.
TEST_F(Runs, AVarianceOfRareValuesIsDecidedWhateverItsPilotSaw) {
  int put_off = 0;
  const std::string suite =
      "suite: rare\nestimators: {it: {plugin: analytic/law, law: bernoulli(0.0002), primaries: "
      "1}}\n"
      "tests: [{claim: variance(it) == analytic, detect: 90%}]\n";
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const reports::Test test = run_test(suite, {.seed = seed});
    EXPECT_THAT(test.message, Not(HasSubstr("few observations"))) << seed;
    put_off += test.looks.size() == 1 && test.samples[0].secondaries > 65536;
  }
  EXPECT_GT(put_off, 0);
}

TEST_F(Runs, SeedsChangeTheNumbers) {
  const reports::Record one = run_text(good_suite(), {.seed = 1});
  const reports::Record two = run_text(good_suite(), {.seed = 2});
  EXPECT_EQ(one.seed, 1);
  EXPECT_EQ(two.seed, 2);
  for (const reports::Test& test : one.suites[0].tests) {
    const reports::Test& other = test_named(two, test.name);
    EXPECT_NE(test.channels[0].statistic, other.channels[0].statistic) << test.name;
  }
}

TEST_F(Runs, TakesTheSuitesSeedUnlessGivenAnother) {
  const std::string seeded = "seed: 7\n" + good_suite();
  EXPECT_EQ(run_text(seeded).suites[0].seed, 7);
  EXPECT_EQ(run_text(seeded, {.seed = 3}).suites[0].seed, 3);
  EXPECT_EQ(run_text(good_suite()).suites[0].seed, 1);
}

TEST_F(Runs, AlphaAndCoarsenReplaceTheSuites) {
  const reports::Record record = run_text(good_suite(), {.alpha = 0.05, .coarsen = 2});
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
      "suite.yaml", good_suite("  - {claim: variance(normal) == 1, name: bad, test: welch}\n")));
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
  EXPECT_EQ(code({outcome_of(Verdict::inconclusive)}, InconclusivePolicy::fail), 1);
  EXPECT_EQ(code({outcome_of(Verdict::inconclusive)}, InconclusivePolicy::pass), 0);
  EXPECT_EQ(code({}), 4);
  EXPECT_EQ(code({outcome_of(Verdict::skipped), outcome_of(Verdict::skipped)}), 77);
}

}  // namespace
}  // namespace assay::harness
