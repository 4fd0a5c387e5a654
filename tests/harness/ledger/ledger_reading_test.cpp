#include "harness/ledger/ledger.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<LedgerNight> nights_of(const std::vector<double>& differences) {
  std::vector<LedgerNight> nights;
  for (const double each : differences) {
    nights.push_back({.value = stats::NightEstimate{each, 0.5, 100, 33}});
  }
  return nights;
}

/// Nights that are enough to be judged by.
std::vector<LedgerNight> enough(double difference) {
  return nights_of(std::vector<double>(25, difference));
}

const LedgerSeries read_series{.reference_error = 0.1};

double last_e(const std::vector<LedgerNight>& nights, const stats::Range& claimed) {
  return log_e_path(read_series, nights, claimed).back();
}

TEST(LedgerReading, ThePathIsTheEValueOfAllNightsSoFar) {
  const auto nights = enough(0.2);
  const auto path = log_e_path(read_series, nights, {0, 0});
  ASSERT_EQ(path.size(), nights.size());
  stats::PooledNights pooled;
  for (std::size_t i = 0; i < nights.size(); ++i) {
    pooled.add(std::get<stats::NightEstimate>(nights[i].value));
    EXPECT_EQ(path[i], stats::log_e_value(pooled, {.reference_error = 0.1})) << i;
  }
}

// The least E over the claimed values, found here on a grid of them.
TEST(LedgerReading, TheEValueOfARangeIsTheLeastOverIt) {
  for (const double difference : {-2.25, -0.5, 0.125, 0.75, 10.0}) {
    double least = infinity;
    for (int i = -100; i <= 100; ++i) {
      const double theta = 0.7 * i / 100;
      least = std::min(least, last_e(enough(difference), {theta, theta}));
    }
    const double found = last_e(enough(difference), {-0.7, 0.7});
    EXPECT_LE(found, least + 1e-12) << difference;
    EXPECT_NEAR(found, least, 1e-2) << difference;
  }
}

TEST(LedgerReading, AnInequalityHasOneSide) {
  const double at_none = last_e(enough(0), {0, 0});
  EXPECT_EQ(last_e(enough(-2), {-infinity, 0}), at_none);
  EXPECT_EQ(last_e(enough(2), {-infinity, 0}), last_e(enough(2), {0, 0}));
  EXPECT_EQ(last_e(enough(2), {0, infinity}), at_none);
}

TEST(LedgerReading, PValuesKnowNoRange) {
  const LedgerSeries law;
  std::vector<LedgerNight> nights;
  stats::PooledPValues pooled;
  for (const double log_p : {-0.5, -9.0, -7.0}) {
    nights.push_back({.value = NightLogP{log_p}});
    pooled.add(log_p);
  }
  EXPECT_EQ(log_e_path(law, nights, {0, infinity}).back(), stats::log_e_value(pooled));
  EXPECT_EQ(moved(law, nights, {0, infinity}).night, 1U);
}

TEST(LedgerReading, TellsWhenThetaMoved) {
  std::vector<double> differences(10, 0);
  differences.resize(30, 1.5);
  const Moved change = moved(read_series, nights_of(differences), {0, 0});
  EXPECT_EQ(change.night, 10U);
  EXPECT_LE(change.from, 10U);
  EXPECT_GE(change.to, 10U);
  EXPECT_LT(change.to, 20U);
}

TEST(LedgerReading, SharesOfAllSeriesSumToOne) {
  double sum = 0;
  for (int k = 1; k < 1000; ++k) sum += generation_share(k);
  EXPECT_LE(sum, 1);
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_NEAR(generation_share(1), 0.8319, 1e-4);
}

}  // namespace
}  // namespace assay::harness
