// Rows that depend on each other: what the order tells, and what is made of it.

#include "tests/harness/recorded_rows.h"
#include "tests/prelude.h"
#include "tests/stats/calibration.h"

namespace assay::harness {
namespace {

using reports::Verdict;

// Ten chains that take turns: neighbours are of different chains and know nothing of each other.
TEST(DependentRows, OfChainsThatTakeTurnsAreInvalid) {
  Philox random(5);
  std::vector<double> state(10);
  std::vector<double> rows;
  for (int step = 0; step < 400; ++step) {
    for (double& x : state) rows.push_back(x = .9 * x + random.normal());
  }
  const reports::Test test = judged(rows, "claim: mean(rows) == 0");
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_THAT(test.message, HasSubstr("those 10 apart have a rank correlation of 0."));
}

// A program whose observation is the mean of five neighbours' random numbers, and its sound sister.
TEST(DependentDraws, OfAProgramAreInvalidEvenIfForced) {
  const Workplace place;
  place.write("moving.py", "import random, sys\nsys.path.append('" ASSAY_SOURCE_DIR
                           R"(/estimators/foreign/python')
import assay
def moving(rng, primaries, *, wide: int):
    noise = [random.Random(rng.key << 64 | rng.index + i).random() for i in range(wide)]
    return sum(noise) / wide
assay.serve(moving)
)");
  const auto judged_with = [&](const std::string& wide, const std::string& more, int seed) {
    const std::string file =
        place.write("moving.yaml",
                    "suite: moving\nestimators:\n  x: {plugin: process, command: [python3, "
                    "moving.py, wide=" +
                        wide + "]}\ntests:\n  - {claim: mean(x) == 0.5" + more + "}\n");
    return run_files({file}, {.seed = seed}).suites[0].tests[0];
  };
  for (int seed = 1; seed <= (tests::is_long() ? 5 : 2); ++seed) {
    const reports::Test test = judged_with("5", "", seed);
    EXPECT_EQ(test.verdict, Verdict::invalid) << test.message;
    EXPECT_THAT(test.message, HasSubstr("the observations of `x` are not independent"));
    EXPECT_EQ(judged_with("1", "", seed).verdict, Verdict::pass);
  }
  EXPECT_EQ(judged_with("5", ", test: t", 1).verdict, Verdict::invalid);
}

TEST(DependentRows, OfOneLongChainAreTestedByBatchMeans) {
  const reports::Test test = judged(chain(0.9, 8000, 5), "claim: mean(rows) == 0");
  EXPECT_EQ(test.method, "batch-means");
  EXPECT_EQ(test.verdict, Verdict::pass);
  bool noted = false;
  for (const reports::Gate& gate : test.gates) {
    noted = noted || gate.name == "correlation of successive values, rows of rows";
  }
  EXPECT_TRUE(noted);
}

// Correlations that no gate calls beyond chance make the mean less certain than its spread says.
TEST(DependentRows, ThatMayDependOnEachOtherAreAllowedFor) {
  int allowed = 0;
  for (std::uint32_t stream = 1; stream <= 12; ++stream) {
    const std::vector<double> rows = chain(0.12, 400, stream);
    const reports::Test test = judged(rows, "claim: mean(rows) == 0");
    const reports::Test forced = judged(rows, "claim: mean(rows) == 0, test: t");
    for (const reports::Gate& gate : test.gates) {
      if (gate.name != "variance of the mean, allowed for dependence, rows of rows") continue;
      if (test.verdict == Verdict::invalid) continue;
      ++allowed;
      EXPECT_GT(*gate.value, 1);
      EXPECT_EQ(gate.state, "amber");
      const auto width = [](const reports::Test& each) {
        const reports::Effect& effect = each.channels.at(0).effect;
        return *effect.high - *effect.low;
      };
      EXPECT_NEAR(width(test) / width(forced), std::sqrt(*gate.value), 1e-9);
    }
  }
  EXPECT_GE(allowed, 4);
}

TEST(DependentRows, OfAShortChainAreInvalidAndSayWhatTheyAreWorth) {
  for (const char* claim :
       {"claim: mean(rows) == 0", "claim: 'distribution(rows) == normal(0, 1)'"}) {
    const reports::Test test = judged(chain(0.9, 400, 6), claim);
    EXPECT_EQ(test.verdict, Verdict::invalid);
    EXPECT_THAT(test.message, HasSubstr("are not independent: 400 of them are worth about"));
  }
}

// Rows of which each leans away from the one before are worth more than as many independent ones.
TEST(DependentRows, ThatAlternateSayTheirCorrelation) {
  const reports::Test test =
      judged(chain(-0.5, 1001, 6), "claim: 'distribution(rows) == normal(0, 1)'");
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_THAT(test.message,
              testing::ContainsRegex("those 1 apart have a rank correlation of -0[.][45]"));
  EXPECT_THAT(test.message, testing::Not(HasSubstr("are worth")));
}

TEST(DependentRows, OfAChainForceNoTestOfIndependentRows) {
  const reports::Test forced = judged(chain(0.9, 8000, 5), "claim: mean(rows) == 0, test: t");
  EXPECT_EQ(forced.verdict, Verdict::invalid);
  EXPECT_THAT(forced.message, HasSubstr("leave `test` out"));
  const reports::Test batches =
      judged(chain(0.9, 8000, 5), "claim: mean(rows) == 0, test: batch-means");
  EXPECT_EQ(batches.verdict, Verdict::pass) << batches.message;
}

TEST(DependentRows, OfDependentValuesHaveNoVarianceToTest) {
  const reports::Test test = judged(chain(0.9, 8000, 7), "claim: variance(rows) <= 2");
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_THAT(test.message, HasSubstr("are not independent"));
}

/// The test of two files of rows.
reports::Test compared(const std::vector<double>& a, const std::vector<double>& b,
                       const std::string& test) {
  const Workplace place;
  place.write("a.txt", file_of(a));
  place.write("b.txt", file_of(b));
  return run_files({place.write("suite.yaml",
                                "suite: s\nestimators:\n  a: {plugin: recorded, file: a.txt}\n"
                                "  b: {plugin: recorded, file: b.txt}\ntests:\n  - {" +
                                    test + "}\n")})
      .suites[0]
      .tests[0];
}

// A side is worth 420 independent rows. Nobody can force Welch's test of the rows, which would fail
// under half of the seeds. Its test of batches fails under more than 3 of 30 with probability 3e-4.
TEST(DependentRows, OfTwoChainsAreComparedByTheirBatches) {
  int failed = 0;
  for (std::uint32_t stream = 0; stream < 30; ++stream) {
    const std::vector<double> a = chain(0.9, 8000, 2 * stream + 1);
    const std::vector<double> b = chain(0.9, 8000, 2 * stream + 2);
    const reports::Test test = compared(a, b, "claim: mean(a) == mean(b)");
    EXPECT_EQ(test.method, "batch-means");
    failed += test.verdict == Verdict::fail;
    if (stream >= 5) continue;
    EXPECT_EQ(compared(a, b, "claim: mean(a) == mean(b), test: welch").verdict, Verdict::invalid);
  }
  EXPECT_LE(failed, 3);
}

// Half a deviation is 7 standard errors.
TEST(DependentRows, OfTwoChainsThatDifferFail) {
  std::vector<double> shifted = chain(0.9, 8000, 3);
  for (double& x : shifted) x += 0.5;
  EXPECT_EQ(compared(chain(0.9, 8000, 4), shifted, "claim: mean(a) == mean(b)").verdict,
            Verdict::fail);
}

// 8000 rows are worth 420: of the interval and of the pair's p-value as of the verdict.
TEST(DependentRows, AreShownAsUncertainAsTheyAre) {
  const Workplace place;
  place.write("a.txt", file_of(chain(0.9, 8000, 31)));
  place.write("b.txt", file_of(chain(0.9, 8000, 32)));
  const reports::Suite suite =
      run_files({place.write("suite.yaml",
                             "suite: s\nestimators:\n  a: {plugin: recorded, file: a.txt}\n"
                             "  b: {plugin: recorded, file: b.txt}\n"
                             "tests: [{claim: mean(a) == mean(b)}]\n")})
          .suites[0];
  const reports::Estimate& mean = suite.estimators[0].channels[0].mean;
  // 2.58 standard errors of .049 to either side.
  EXPECT_NEAR(*mean.high - *mean.low, 0.25, 0.07);
  const double p = *suite.tests[0].channels[0].p_value;
  EXPECT_NEAR(std::log(*suite.comparisons[0].mean_p), std::log(p), 1 + 0.5 * std::abs(std::log(p)));
  EXPECT_FALSE(suite.comparisons[0].variances_differ);
}

// A column that never varies has no batches: it is judged by itself.
TEST(DependentRows, BesideAConstantColumnAreTestedByBatches) {
  std::string text = "# columns: moving still\n";
  for (const double x : chain(0.9, 8000, 5)) text += fmt::format("{} 2\n", 2 + x);
  const Workplace place;
  place.write("rows.txt", text);
  const reports::Test test =
      run_files({place.write("suite.yaml",
                             "suite: s\nestimators:\n  r: {plugin: recorded, file: rows.txt}\n"
                             "tests: [{claim: mean(r) == 2}]\n")})
          .suites[0]
          .tests[0];
  EXPECT_EQ(test.method, "batch-means");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
}

// Averages have another law, and another variance: rows can be left out only.
TEST(DependentRows, SayWhatWouldDo) {
  const std::vector<double> rows = chain(0.9, 400, 6);
  EXPECT_THAT(judged(rows, "claim: mean(rows) == 0").message,
              HasSubstr("rows at least, of which batches are then averaged"));
  EXPECT_THAT(judged(rows, "claim: mean(rows) within 0.5 of 0").message,
              HasSubstr("successive rows each, 100 of them at least"));
  EXPECT_THAT(judged(rows, "claim: 'distribution(rows) == normal(0, 1)'").message,
              HasSubstr("give one row a chain, or keep one row in "));
}

// Neighbours that depend on each other are one chain, however far off another lag looks.
TEST(DependentRows, OfOneChainAreNotCalledManyThatTakeTurns) {
  for (std::uint32_t stream = 1; stream <= 20; ++stream) {
    const reports::Test test =
        judged(chain(0.4, 350, stream), "claim: 'distribution(rows) == normal(0, 1)'");
    EXPECT_THAT(test.message, testing::Not(HasSubstr("take turns")));
  }
}

}  // namespace
}  // namespace assay::harness
