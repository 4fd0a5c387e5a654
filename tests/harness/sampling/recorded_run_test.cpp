#include "harness/base/text_file.h"
#include "harness/command/commands.h"
#include "harness/sampling/prepare.h"
#include "reports/report_formats.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

// Drawn once: moments of primaries, of means of 64, of two channels, of an image, and rows.
constexpr const char* baseline = R"(suite: baseline
estimators:
  normal: {plugin: analytic/normal, mean: 2, deviation: 1, primaries: 1}
  uniform: {plugin: analytic/exponential_uniform, primaries: 64}
  area: {plugin: luminaire/area, scene: triangle, primaries: 64}
  roulette: {plugin: analytic/dart_throwing, primaries: 64}
  floor: {plugin: luminaire/floor, width: 8, height: 8, primaries: 4}
tests:
  - {claim: mean(normal) == 2, secondaries: 20000}
  - {claim: variance(normal) == 1, secondaries: 500}
  - {claim: mean(uniform) == analytic, secondaries: 4000}
  - {claim: efficiency(area) > 1e-6, secondaries: 3000}
  - {claim: mean(area) == analytic, secondaries: 5000}
  - {claim: mean(floor) == analytic}
  - {claim: 'distribution(roulette) == uniform(0, 1)'}
)";

class RecordedRunTest : public InFolder {
 protected:
  static void TearDownTestSuite() { record_.reset(); }

  void SetUp() override {
    if (!record_) record_ = run_files({place_.write("baseline.yaml", baseline)}, {.seed = 5});
    write_whole(place_.file("run.json"), reports::json(*record_));
  }

  /// A suite whose estimators are these lines and whose only test is `test`.
  std::string suite(const std::string& estimators, const std::string& test) {
    return place_.write("suite.yaml",
                        "suite: next\nestimators:\n" + estimators + "tests:\n  - {" + test + "}\n");
  }
  reports::Test tested(const std::string& estimators, const std::string& test,
                       std::uint64_t seed = 1) {
    return run_files({suite(estimators, test)}, {.seed = seed, .threads = 1}).suites[0].tests[0];
  }
  std::string refused(const std::string& estimators, const std::string& test) {
    const std::string file = suite(estimators, test);
    return refusal([&] { run_files({file}); });
  }
  static std::string old(const std::string& name) {
    return "  old: {plugin: recorded, run: run.json, estimator: " + name + "}\n";
  }

  static std::optional<reports::Record> record_;
};

std::optional<reports::Record> RecordedRunTest::record_;

constexpr const char* new_normal =
    "  new: {plugin: analytic/normal, mean: 2, deviation: 1, primaries: 1}\n";

TEST_F(RecordedRunTest, HasTheMomentsOfItsLargestTestForWelchsStatistic) {
  const reports::Test test =
      tested(old("normal") + new_normal, "claim: mean(new) == mean(old), test: welch", 6);
  ASSERT_EQ(test.samples.size(), 2);
  const reports::Sample& now = test.samples[1];
  const reports::Sample& then = record_->suites[0].tests[0].samples[0];
  EXPECT_EQ(now.plugin, "recorded");
  EXPECT_EQ(now.secondaries, 20000);
  EXPECT_EQ(now.mean, then.mean);
  EXPECT_NEAR(*now.variance, *then.variance, 1e-14);
  EXPECT_NEAR(*now.skewness, *then.skewness, 1e-12);
  EXPECT_NEAR(*now.kurtosis, *then.kurtosis, 1e-12);
  EXPECT_EQ(now.min, then.min);
  const reports::Sample& x = test.samples[0];
  EXPECT_EQ(x.secondaries, 20000);
  const double z = (*x.mean - *now.mean) / std::sqrt((*x.variance + *now.variance) / 20000);
  EXPECT_NEAR(*test.channels[0].statistic, z, 1e-9);
}

TEST_F(RecordedRunTest, ComparesVariancesOfOnePrimaryWhateverTheRunsPrimaries) {
  const reports::Test test =
      tested(old("uniform") + "  new: {plugin: analytic/exponential_uniform, primaries: 16}\n",
             "claim: variance(new) == variance(old)", 6);
  EXPECT_EQ(test.samples[1].primaries, 64);
  EXPECT_EQ(test.samples[1].secondaries, 4000);
  const double ratio = 16 * *test.samples[0].variance / (64 * *test.samples[1].variance);
  EXPECT_NEAR(*test.channels[0].effect.estimate, std::log(ratio), 1e-12);
}

// False-alarm rates 1e-5: the suite's alpha. Efficiency is 1 / 1.2^2 = 0.69 of the old one; its
// logarithm is known to .02 or better from 20000 and 3000 observations.
TEST_F(RecordedRunTest, FindsALossOfEfficiencyWithoutRunningTheOldEstimator) {
  const std::string claim = "claim: efficiency(new) >= 0.95 * efficiency(old), cost: samples";
  const auto verdict = [&](const std::string& estimator) {
    const std::string file = suite(old("normal") + estimator, claim);
    return run_files({file}, {.seed = 6, .alpha = 1e-5}).suites[0].tests[0].verdict;
  };
  EXPECT_EQ(verdict(new_normal), Verdict::pass);
  EXPECT_EQ(verdict("  new: {plugin: analytic/normal, mean: 2, deviation: 1.2, primaries: 1}\n"),
            Verdict::fail);
}

TEST_F(RecordedRunTest, KnowsTheRunsRaysAndHowTheyVary) {
  const reports::Test test =
      tested(old("area") + "  new: {plugin: luminaire/area, scene: triangle, primaries: 64}\n",
             "claim: efficiency(new) >= 0.5 * efficiency(old)", 6);
  EXPECT_EQ(test.verdict, Verdict::pass);
  EXPECT_EQ(test.samples[1].secondaries, 3000);  // the test that kept how costs vary
  const reports::Sample& then = record_->suites[0].tests[3].samples[0];
  ASSERT_EQ(then.with_cost.size(), 2);
  EXPECT_EQ(test.samples[1].with_cost, then.with_cost);
  EXPECT_EQ(test.samples[1].cost.shadow_rays, then.cost.shadow_rays);
}

// Means of 64 of a kurtosis just below 3, as by chance: 64 times as far below it no law is.
TEST_F(RecordedRunTest, OfMeansThatAreFlatterThanNormalAnswers) {
  reports::Record flat =
      run_files({suite("  mean: {plugin: analytic/law, law: 'uniform(0, 1)', primaries: 64}\n",
                       "claim: mean(mean) == 0.5, secondaries: 1000")});
  flat.suites[0].tests[0].samples[0].kurtosis = 2.9;
  write_whole(place_.file("run.json"), reports::json(flat));
  const reports::Test test =
      tested(old("mean") + "  new: {plugin: analytic/law, law: 'uniform(0, 1)', primaries: 64}\n",
             "claim: mean(new) == mean(old)");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
}

// The record's seed is 5: under it the new side would draw the very numbers of the record.
TEST_F(RecordedRunTest, SharesNoStreamWithTheNewRun) {
  const reports::Test test = tested(old("normal") + new_normal, "claim: mean(new) == mean(old)", 5);
  EXPECT_NE(test.samples[0].mean, test.samples[1].mean);
  const reports::Test both =
      tested(new_normal + std::string("  twin: {plugin: analytic/normal, mean: 2, primaries: 1}\n"),
             "claim: mean(new) == mean(twin), secondaries: 20000", 5);
  EXPECT_EQ(both.samples[0].mean, test.samples[1].mean);
  EXPECT_EQ(both.samples[1].mean, test.samples[0].mean);
}

// `timeout` and `memory` stand in the record and shape no draw.
TEST_F(RecordedRunTest, OfAProgramSharesNoStreamWithTheNewRun) {
  place_.write("mine.sh",
               "printf 'assay 1 text\\nchannel x\\nready\\n'\n"
               "while read -r high low first count primaries; do\n"
               "  i=$first\n"
               "  while [ $i -lt $((first + count)) ]; do\n"
               "    echo $(((low / 97 + i * 7919) % 1009)); i=$((i + 1))\n"
               "  done\n"
               "  echo \"$high $low $first $count $primaries\"\n"
               "done\n");
  const std::string mine = "  mine: {plugin: process, command: [sh, mine.sh]}\n";
  const std::string claim = "claim: mean(mine) > 1, secondaries: 200";
  write_whole(place_.file("run.json"), reports::json(run_files({suite(mine, claim)})));
  const reports::Test test =
      tested(old("mine") + mine, "claim: mean(mine) == mean(old), secondaries: 200");
  ASSERT_EQ(test.samples.size(), 2) << test.message;
  EXPECT_NE(test.samples[0].mean, test.samples[1].mean) << test.message;
}

TEST_F(RecordedRunTest, TheTableOfEstimatorsShowsWhatTheTestDrew) {
  const reports::Suite next =
      run_files({suite(old("normal") + new_normal, "claim: mean(new) == mean(old)")}, {.seed = 5})
          .suites[0];
  ASSERT_EQ(next.estimators.size(), 2);
  EXPECT_EQ(next.estimators[1].name, "new");
  EXPECT_EQ(next.estimators[1].channels[0].mean.value, next.tests[0].samples[0].mean);
}

TEST_F(RecordedRunTest, OfASecondSourceLeavesTheFirstStreamToTheNewRun) {
  const std::string twin = "  twin: {plugin: analytic/normal, mean: 2, primaries: 1}\n";
  const reports::Record pair =
      run_files({suite(new_normal + twin, "claim: mean(new) == mean(twin), secondaries: 900")});
  write_whole(place_.file("run.json"), reports::json(pair));
  const reports::Test test = tested(old("twin") + new_normal, "claim: mean(new) == mean(old)");
  EXPECT_EQ(test.samples[0].mean, pair.suites[0].tests[0].samples[0].mean);
  EXPECT_EQ(test.samples[1].mean, pair.suites[0].tests[0].samples[1].mean);
}

TEST_F(RecordedRunTest, OfAMutantKnowsThatItsStreamIsTheOriginals) {
  const std::string mutant = "  bad: {plugin: mutants/no_cosine, scene: triangle, primaries: 64}\n";
  const reports::Record run =
      run_files({suite(mutant, "claim: mean(bad) == analytic, secondaries: 200, expect: fail")});
  write_whole(place_.file("run.json"), reports::json(run));
  const std::string area = "  new: {plugin: luminaire/area, scene: triangle, primaries: 64}\n";
  const std::string other = "  other: {plugin: luminaire/area, scene: triangle, primaries: 64}\n";
  const reports::Test test = tested(old("bad") + area, "claim: mean(new) == mean(old)");
  const reports::Test two =
      tested(area + other, "claim: mean(other) == mean(new), secondaries: 200");
  EXPECT_EQ(test.samples[0].mean, two.samples[1].mean);  // the copy
}

TEST_F(RecordedRunTest, CanBeReplayed) {
  const reports::Record run =
      run_files({suite(old("uniform") + "  new: {plugin: analytic/exponential_uniform}\n",
                       "name: both, claim: mean(new) == mean(old)")},
                repeatable);
  const std::string file = place_.file("next.json");
  write_whole(file, reports::json(run));
  EXPECT_EQ(replay({.record = file, .test = "both"}), 0);
  EXPECT_EQ(replay({.record = file, .test = "both", .observation = 3}), 0);
}

TEST_F(RecordedRunTest, RefusesWhatMomentsDoNotTell) {
  const std::string both = old("normal") + new_normal;
  for (const char* claim :
       {"claim: distribution(new) == distribution(old)",
        "claim: 'distribution(old) == normal(2, 1)'", "claim: 'quantile(old, 0.5) == 2'",
        "claim: total_variance(new) == total_variance(old)"}) {
    EXPECT_THAT(refused(both, claim), HasSubstr("has the moments of a run, not its observations"))
        << claim;
  }
  EXPECT_THAT(refused(both, "claim: efficiency(new) >= efficiency(old), cost: seconds"),
              HasSubstr("is read, maybe from an earlier run: its seconds mean nothing"));
  EXPECT_THAT(refused(both, "claim: mean(new) == mean(old), secondaries: 100"),
              HasSubstr("moments of 20000 observations together; leave `secondaries` out"));
  EXPECT_THAT(refused(both, "claim: mean(old) == 2, test: batch-means"),
              HasSubstr("`test: batch-means` needs observations"));
}

TEST_F(RecordedRunTest, RefusesCostsThatTheRunDoesNotTell) {
  reports::Record uneven = *record_;
  uneven.suites[0].tests[0].samples[0].cost.samples += 1;
  write_whole(place_.file("run.json"), reports::json(uneven));
  EXPECT_THAT(refused(old("normal") + new_normal,
                      "claim: efficiency(new) >= efficiency(old), cost: samples"),
              HasSubstr("did not record how its costs vary"));
}

TEST_F(RecordedRunTest, NamesWhatIsWrongWithTheRunOrTheEstimator) {
  const auto refused_as = [&](const std::string& parameters) {
    return refused("  old: {plugin: recorded, " + parameters + "}\n", "claim: mean(old) == 2");
  };
  EXPECT_THAT(refused_as("run: none.json"), HasSubstr("there is no such file"));
  EXPECT_THAT(refused_as("run: suite.yaml"), HasSubstr("looks like a suite, not a saved run"));
  EXPECT_THAT(refused_as("run: run.json"), HasSubstr("has several estimators"));
  EXPECT_THAT(refused_as("run: run.json, estimator: norml"), HasSubstr("did you mean `normal`?"));
  EXPECT_THAT(refused_as("run: run.json, estimator: roulette"), HasSubstr("has no moments in the"));
  EXPECT_THAT(refused_as("run: run.json, estimator: floor"), HasSubstr("has no moments in the"));
  EXPECT_THAT(refused_as("run: run.json, estimator: normal, primaries: 8"),
              HasSubstr("leave `primaries` out"));
  EXPECT_THAT(refused_as("run: run.json, estimator: normal, file: x.txt"),
              HasSubstr("give it or `run`, not both"));
  EXPECT_THAT(refused_as("file: x.txt, estimator: normal"), HasSubstr("estimator"));
  EXPECT_THAT(refused_as("column: x"), HasSubstr("is needed, or `run` and `estimator`"));
  place_.write("cut.json", "{\"schema\": 1");
  EXPECT_THAT(refused_as("run: cut.json"), HasSubstr("is no record of a run"));
}

TEST_F(RecordedRunTest, RefusesTwoRunsOfOneStream) {
  write_whole(place_.file("again.json"), reports::json(*record_));
  EXPECT_THAT(
      refused(old("normal") + "  older: {plugin: recorded, run: again.json, estimator: normal}\n",
              "claim: mean(old) == mean(older)"),
      HasSubstr("drawn from the same stream"));
}

}  // namespace
}  // namespace assay::harness
