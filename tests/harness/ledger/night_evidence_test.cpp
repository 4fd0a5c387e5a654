#include "harness/ledger/night_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/run/looks.h"
#include "harness/run/planned_run.h"
#include "tests/harness/running.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

/// A suite whose tests have run, with everything that belongs to them.
struct Ran {
  std::vector<Suite> suites;
  PlannedRun planned;

  const TestWork& test(std::size_t i) const { return planned.suites[0]->tests[i]; }
  NightEvidence night(std::size_t i) const {
    return night_evidence(test(i), 0, planned.suites[0]->pilots);
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
tests:
)" + tests))};
  Silence silence;
  ran.planned = plan_run(ran.suites, {.seed = seed}, silence);
  std::vector<TestWork*> works;
  for (TestWork& work : ran.planned.suites[0]->tests) works.push_back(&work);
  sample_in_looks(works, ran.planned.pools.all(), 1, silence);
  return ran;
}

void write_data(const Workplace& place) {
  std::string rows;
  tests::Philox random(1);
  for (int i = 0; i < 400; ++i) rows += std::to_string(2 + 0.2 * (random.uniform() - 0.5)) + "\n";
  place.write("mine.txt", rows);
}

TEST(NightEvidence, OfAMeanIsItsScoreAndInformation) {
  const Workplace place;
  write_data(place);
  const Ran ran = run_nights(place, "  - {claim: mean(normal) == 2, detect: 0.1}\n");
  const stats::Moments x = ran.moments(0);
  const NightEvidence night = ran.night(0);
  ASSERT_EQ(night.missing, "");
  const double n = static_cast<double>(x.count);
  EXPECT_NEAR(night.evidence.information, n / x.variance(), 1e-9 * n);
  // Student's t of n - 1 degrees made normal: within (t^3 + t) / (4 n) of t.
  const double score = n * (x.mean - 2) / x.variance();
  const double t = score / std::sqrt(night.evidence.information);
  EXPECT_NEAR(night.evidence.score / std::sqrt(night.evidence.information), t,
              (std::abs(t * t * t) + std::abs(t)) / (2 * n));
  EXPECT_EQ(night.prior.reference_error, 0);
}

TEST(NightEvidence, OfARelativeMeanIsInUnitsOfTheReference) {
  const Workplace place;
  write_data(place);
  const Ran ran = run_nights(place, "  - {claim: mean(normal) == 2 +- 0.1}\n");
  const stats::Moments x = ran.moments(0);
  const NightEvidence night = ran.night(0);
  const double n = static_cast<double>(x.count);
  EXPECT_NEAR(night.evidence.information, 4 * n / x.variance(), 1e-9 * n);
  EXPECT_NEAR(night.prior.reference_error, 0.05, 1e-15);
  EXPECT_NEAR(night.evidence.score / night.evidence.information, (x.mean - 2) / 2, 1e-4);
}

// The effect is fixed before the first night: by the pilot, whatever the test's own data are.
TEST(NightEvidence, ThePriorsEffectIsAShareOfAnExpectedNight) {
  const Workplace place;
  write_data(place);
  const Ran ran = run_nights(place, "  - {claim: mean(normal) == 2}\n");
  // 16384 secondaries of standard deviation 1, 2 the unit; the pilot knows it to within 5 %.
  EXPECT_NEAR(ran.night(0).prior.effect, std::sqrt(0.2 / 16384) / 2,
              0.05 * std::sqrt(0.2 / 16384) / 2);
}

TEST(NightEvidence, OfTwoMeansAndVariancesHasTheDeltaMethodsInformation) {
  const Workplace place;
  write_data(place);
  const Ran ran = run_nights(place,
                             "  - {claim: mean(normal) == mean(other), detect: 0.1}\n"
                             "  - {claim: variance(normal) == variance(other)}\n");
  const auto error = [](const stats::Moments& x) { return x.variance() / double(x.count); };
  EXPECT_NEAR(ran.night(0).evidence.information,
              1 / (error(ran.moments(0, 0)) + error(ran.moments(0, 1))),
              1e-9 / error(ran.moments(0, 0)));
  // ln of a normal sample's variance has variance 2 / n.
  const double n = static_cast<double>(ran.moments(1).count);
  EXPECT_NEAR(ran.night(1).evidence.information, n / 4, 0.2 * n / 4);
}

TEST(NightEvidence, RecordedDataAreTheSameInEveryRun) {
  const Workplace place;
  write_data(place);
  const Ran ran = run_nights(place,
                             "  - {claim: mean(mine) == 2}\n"
                             "  - {claim: mean(normal) == mean(mine), detect: 0.1}\n"
                             "  - {claim: distribution(normal) == distribution(mine)}\n");
  EXPECT_NE(ran.night(0).missing, "");
  EXPECT_NE(ran.night(2).missing, "");
  const NightEvidence night = ran.night(1);
  ASSERT_EQ(night.missing, "");
  EXPECT_NEAR(night.prior.reference_error, ran.moments(1, 1).standard_error(), 1e-12);
  const stats::Moments x = ran.moments(1);
  EXPECT_NEAR(night.evidence.information, 1 / (x.standard_error() * x.standard_error()),
              1e-9 * night.evidence.information);
}

TEST(NightEvidence, OfADistanceIsTheEValueOfItsPValue) {
  const Workplace place;
  write_data(place);
  const Ran ran = run_nights(place, "  - {claim: 'distribution(normal) == normal(2, 1)'}\n");
  const NightEvidence night = ran.night(0);
  EXPECT_EQ(night.kind, EvidenceKind::log_e);
  EXPECT_EQ(night.log_e,
            stats::log_e_from_log_p(ran.test(0).outcome.channels[0].decision.log_p_claimed));
}

TEST(NightEvidence, TheHashFollowsClaimMarginsAndParametersAlone) {
  const Workplace place;
  write_data(place);
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
