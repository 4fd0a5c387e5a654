// Rows of a file: dependence, bias and level. More of their verdicts are in
// tests/tables/verdicts.txt.

#include "tests/harness/recorded_rows.h"
#include "tests/stats/calibration.h"
#include "tests/stats/laws.h"

namespace assay::harness {
namespace {

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
    const std::string text =
        "suite: moving\nestimators:\n  x: {plugin: process, command: [python3, moving.py, wide=" +
        wide + "]}\ntests:\n  - {claim: mean(x) == 0.5" + more + "}\n";
    return run_in(place, text, {.seed = seed}).tests[0];
  };
  for (int seed = 1; seed <= (tests::is_long() ? 5 : 2); ++seed) {
    const reports::Test test = judged_with("5", "", seed);
    expect_said(test, Verdict::invalid, {"the observations of `x` are not independent"});
    EXPECT_EQ(judged_with("1", "", seed).verdict, Verdict::pass);
  }
  EXPECT_EQ(judged_with("5", ", test: t", 1).verdict, Verdict::invalid);
}

TEST(DependentRows, OfOneLongChainAreTestedByBatchMeans) {
  const reports::Test test = judged(chain(0.9, 8000, 5), "claim: mean(rows) == 0");
  EXPECT_EQ(test.method, "batch-means");
  EXPECT_THAT(test.message, testing::HasSubstr("successive rows are correlated: the interval is"));
  EXPECT_TRUE(std::ranges::any_of(test.gates, [](const reports::Gate& gate) {
    return gate.name == "correlation of successive values, rows of rows";
  }));
}

double width(const reports::Test& test) {
  return *test.channels.at(0).effect.high - *test.channels.at(0).effect.low;
}

// Correlations that no gate calls beyond chance make the mean less certain than its spread says.
TEST(DependentRows, ThatMayDependOnEachOtherAreAllowedFor) {
  int told = 0;
  for (std::uint32_t stream = 1; stream <= 12; ++stream) {
    const std::vector<double> rows = chain(0.12, 400, stream);
    const reports::Test test = judged(rows, "claim: mean(rows) == 0, detect: 0.01");
    const reports::Test forced = judged(rows, "claim: mean(rows) == 0, detect: 0.01, test: t");
    for (const reports::Gate& gate : test.gates) {
      if (gate.name != "variance of the mean, allowed for dependence, rows of rows") continue;
      if (test.verdict != Verdict::inconclusive) continue;
      EXPECT_THAT(test.message, testing::HasSubstr("successive rows look correlated"));
      ++told;
      EXPECT_GT(*gate.value, 1);
      EXPECT_EQ(gate.state, "amber");
      EXPECT_NEAR(width(test) / width(forced), std::sqrt(*gate.value), 1e-9);
    }
  }
  EXPECT_GE(told, 4);
}

TEST(DependentRows, OfBothSidesAreAllowedFor) {
  int both = 0;
  for (std::uint32_t stream = 1; stream <= 20; stream += 2) {
    const auto tests =
        compared(Workplace(), chain(0.12, 400, stream), chain(0.12, 400, stream + 1),
                 "  - {claim: mean(a) == mean(b), detect: 0.01}\n"
                 "  - {name: f, claim: mean(a) == mean(b), detect: 0.01, test: welch}\n")
            .tests;
    const auto allowed = std::ranges::count_if(tests[0].gates, [](const reports::Gate& gate) {
      return gate.name.starts_with("variance of the mean, allowed for dependence");
    });
    if (allowed < 2 || tests[0].verdict != Verdict::inconclusive) continue;
    ++both;
    EXPECT_GT(width(tests[0]), width(tests[1]));
  }
  EXPECT_GE(both, 1);
}

// A side is worth 420 independent rows. Nobody can force Welch's test of the rows, which would fail
// under half of the seeds. Its test of batches fails under more than 3 of 30 with probability 3e-4,
// and under more than 2 of 10 with 1.1e-4.
TEST(DependentRows, OfTwoChainsAreComparedByTheirBatches) {
  const auto [pairs, most] = tests::is_long() ? std::pair{30U, 3} : std::pair{10U, 2};
  int failed = 0;
  for (std::uint32_t stream = 0; stream < pairs; ++stream) {
    const std::vector<double> a = chain(0.9, 8000, 2 * stream + 1);
    const std::vector<double> b = chain(0.9, 8000, 2 * stream + 2);
    const std::vector<reports::Test> tests =
        compared(Workplace(), a, b,
                 "  - {claim: mean(a) == mean(b)}\n"
                 "  - {name: forced, claim: mean(a) == mean(b), test: welch}\n")
            .tests;
    EXPECT_EQ(tests[0].method, "batch-means");
    EXPECT_EQ(tests[1].verdict, Verdict::invalid);
    failed += tests[0].verdict == Verdict::fail;
  }
  EXPECT_LE(failed, most);
}

// 8000 rows are worth 420: of the interval as of the verdict.
TEST(DependentRows, AreShownAsUncertainAsTheyAre) {
  const reports::Suite suite = compared(Workplace(), chain(0.9, 8000, 31), chain(0.9, 8000, 32),
                                        "  - {claim: mean(a) == mean(b)}\n");
  const reports::Estimate& mean = suite.estimators[0].channels[0].mean;
  // 2.58 standard errors of .049 to either side.
  EXPECT_NEAR(*mean.high - *mean.low, 0.25, 0.07);
}

// Neighbours that depend on each other are one chain, however far off another lag looks.
TEST(DependentRows, OfOneChainAreNotCalledManyThatTakeTurns) {
  for (std::uint32_t stream = 1; stream <= 20; ++stream) {
    const reports::Test test =
        judged(chain(0.4, 350, stream), "claim: 'distribution(rows) == normal(0, 1)'");
    EXPECT_THAT(test.message, testing::Not(HasSubstr("take turns")));
  }
}

TEST(Rows, AreOfUnknownBias) {
  const reports::Suite suite = compared(Workplace(), rows_of(60, 1, normal), rows_of(60, 2, normal),
                                        "  - {claim: mean(a) == mean(drawn)}\n");
  for (const reports::EstimatorSummary& row : suite.estimators) {
    EXPECT_EQ(row.bias, row.name == "drawn" ? "unbiased" : "unknown");
  }
}

// Level .05; a rate of 1.25 times it exceeds the bound with probability below 6e-6 (Chernoff, 400
// files). Before there was a least number of rows lognormal(1.5) failed .19 of its true claims at n
// = 50.
TEST(Rows, KeepTheLevelWhateverTheirLaw) {
  const tests::Law heavy{"lognormal(1.5)", std::exp(1.125),
                         [](Philox& r) { return std::exp(1.5 * r.normal()); }};
  for (const tests::Law& law : {laws::normal, laws::exponential, laws::lognormal_one, heavy}) {
    std::map<Verdict, int> count;
    for (std::uint32_t run = 0; run < 400; ++run) {
      const std::string claim = fmt::format("claim: mean(rows) == {}", law.mean);
      ++count[judged(rows_of(100, run, law.draw), claim, 0.05).verdict];
    }
    EXPECT_LE(count[Verdict::fail], 52) << law.name;
    EXPECT_TRUE(count[Verdict::invalid] == 0 || law.name != laws::normal.name);
  }
}

}  // namespace
}  // namespace assay::harness
