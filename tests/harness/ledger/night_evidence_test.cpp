#include "harness/ledger/ledger.h"
#include "harness/run/planned_run.h"
#include "tests/harness/prelude.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

/// A suite whose tests have run, with everything that belongs to them.
struct Ran {
  std::vector<Suite> suites;
  PlannedRun planned;

  const TestWork& test(std::size_t i) const { return planned.suites[0]->tests[i]; }
  NightEvidence night(std::size_t i) const { return night_evidence(test(i), 0); }
  stats::NightEstimate estimate(std::size_t i) const {
    return std::get<stats::NightEstimate>(night(i).value.value());
  }
  std::string missing(std::size_t i) const {
    EXPECT_FALSE(night(i).value);
    return night(i).obstacle;
  }
  stats::Moments moments(std::size_t i, std::size_t subject = 0) const {
    return data_of(*drawn(test(i)), 0)[subject].moments;
  }
};

Ran run_nights(const Workplace& place, const std::string& tests, std::uint64_t seed = 1) {
  Ran ran;
  ran.suites = {load_suite(place.write("suite.yaml", R"(suite: s
estimators:
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  other: {plugin: analytic/normal, mean: 3, primaries: 1}
  mine: {plugin: recorded, file: mine.txt}
  rare: {plugin: analytic/law, law: bernoulli(0.0001), primaries: 1}
tests:
)" + tests))};
  ran.planned = plan_run(ran.suites, {.seed = seed}, silence);
  std::vector<TestWork*> works;
  for (TestWork& work : ran.planned.suites[0]->tests) works.push_back(&work);
  sample_in_looks(works, ran.planned.pools.all(), {.executor = threads(1)}, silence);
  return ran;
}

class EvidenceOfNights : public Placed {
 protected:
  EvidenceOfNights() {
    std::string rows;
    tests::Philox random(1);
    for (int i = 0; i < 400; ++i) rows += std::to_string(2 + 0.2 * (random.uniform() - 0.5)) + "\n";
    place.write("mine.txt", rows);
  }
};

TEST_F(EvidenceOfNights, OfAMeanIsItsEstimateAndErrorPerhapsInUnitsOfTheReference) {
  const Ran ran = run_nights(place,
                             "  - {claim: mean(normal) == 2, detect: 0.1}\n"
                             "  - {claim: mean(normal) == 2 +- 0.1}\n");
  const stats::Moments x = ran.moments(0);
  EXPECT_NEAR(ran.estimate(0).difference, x.mean - 2, 1e-15);
  EXPECT_DOUBLE_EQ(ran.estimate(0).standard_error, x.standard_error());
  EXPECT_EQ(ran.estimate(0).observations, static_cast<double>(x.count));
  EXPECT_NEAR(ran.estimate(0).effective, static_cast<double>(x.count) / x.kurtosis(), 1e-6);
  EXPECT_EQ(ran.night(0).reference_error, 0);
  const stats::Moments y = ran.moments(1);
  EXPECT_NEAR(ran.estimate(1).difference, (y.mean - 2) / 2, 1e-15);
  EXPECT_DOUBLE_EQ(ran.estimate(1).standard_error, y.standard_error() / 2);
  EXPECT_NEAR(ran.night(1).reference_error.value(), 0.05, 1e-15);
}

TEST_F(EvidenceOfNights, OfTwoMeansAndVariancesHasTheDeltaMethodsError) {
  const Ran ran = run_nights(place,
                             "  - {claim: mean(normal) == mean(other), detect: 0.1}\n"
                             "  - {claim: variance(normal) == variance(other)}\n");
  EXPECT_NEAR(ran.estimate(0).standard_error,
              std::hypot(ran.moments(0, 0).standard_error(), ran.moments(0, 1).standard_error()),
              1e-12);
  const double each = static_cast<double>(ran.moments(0).count) / 3;
  EXPECT_NEAR(ran.estimate(0).effective, 2 * each, 0.2 * each) << "normal values of two sides";
  // ln of a normal sample's variance has variance 2 / n.
  const double n = static_cast<double>(ran.moments(1).count);
  EXPECT_NEAR(ran.estimate(1).standard_error, std::sqrt(4 / n), 0.1 * std::sqrt(4 / n));
}

// Three families that tell no error of theirs. Half their interval of 68.3 % is near the error of
// the normal limit, which for the median of a normal law is sqrt(pi / 2n).
TEST_F(EvidenceOfNights, WithoutAnErrorIsHalfTheIntervalOfOneStandardDeviation) {
  const Ran ran = run_nights(place,
                             "  - {claim: 'quantile(normal, 0.5) == 2', secondaries: 1000}\n"
                             "  - {claim: cost(normal) == cost(other), cost: seconds}\n");
  const double expected = std::sqrt(std::acos(-1.0) / 2 / 1000);
  EXPECT_NEAR(ran.estimate(0).standard_error, expected, 0.3 * expected);
  EXPECT_LT(std::abs(ran.estimate(0).difference), 5 * expected);
  EXPECT_GT(ran.estimate(1).standard_error, 0);
}

// Rare values are missing from most nights, which must not be left out for it.
TEST_F(EvidenceOfNights, ValuesWithoutSpreadHaveAnEstimate) {
  const Ran ran =
      run_nights(place, "  - {claim: mean(rare) == 0.0001, detect: 50%, secondaries: 100}\n");
  EXPECT_DOUBLE_EQ(ran.estimate(0).difference, -1);
  EXPECT_EQ(ran.estimate(0).standard_error, 0);
}

TEST_F(EvidenceOfNights, RecordedDataAreTheSameInEveryRun) {
  const Ran ran = run_nights(place,
                             "  - {claim: mean(mine) == 2}\n"
                             "  - {claim: mean(normal) == mean(mine), detect: 0.1}\n"
                             "  - {claim: distribution(normal) == distribution(mine)}\n");
  EXPECT_NE(ran.missing(0), "");
  EXPECT_NE(ran.missing(2), "");
  EXPECT_NEAR(ran.night(1).reference_error.value(), ran.moments(1, 1).standard_error(), 1e-12);
  EXPECT_NEAR(ran.estimate(1).standard_error, ran.moments(1).standard_error(), 1e-12);
}

TEST_F(EvidenceOfNights, OfADistanceIsItsPValue) {
  const Ran ran = run_nights(place, "  - {claim: 'distribution(normal) == normal(2, 1)'}\n");
  EXPECT_EQ(std::get<NightLogP>(ran.night(0).value.value()),
            ran.test(0).outcome.channels[0].decision.log_p_claimed);
}

TEST_F(EvidenceOfNights, TheHashFollowsClaimMarginsAndParametersAlone) {
  const Ran one = run_nights(place,
                             "  - {claim: mean(normal) == 2, detect: 1%}\n"
                             "  - {claim: 'mean(normal)  ==  2.0', name: same, detect: 1%}\n"
                             "  - {claim: mean(normal) == 2, name: margin, detect: 2%}\n"
                             "  - {claim: mean(normal) == 2.5, name: number, detect: 1%}\n"
                             "  - {claim: mean(other) == 2, name: estimator, detect: 1%}\n");
  const Ran two = run_nights(place, "  - {claim: mean(normal) == 2, detect: 1%, weight: 3}\n", 9);
  const std::string hash = series_hash(one.test(0), 0);
  EXPECT_EQ(series_hash(one.test(1), 0), hash);
  EXPECT_EQ(series_hash(two.test(0), 0), hash);
  for (const std::size_t i : {2U, 3U, 4U}) EXPECT_NE(series_hash(one.test(i), 0), hash) << i;
}

}  // namespace
}  // namespace assay::harness
