#include "harness/ledger/ledger_reading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace assay::harness {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<LedgerNight> nights_of(const std::vector<stats::Evidence>& evidence) {
  std::vector<LedgerNight> nights;
  for (const stats::Evidence& each : evidence) nights.push_back({.evidence = each});
  return nights;
}

const LedgerSeries series{.prior = {.effect = 0.5, .reference_error = 0.1}};

TEST(LedgerReading, ThePathIsTheEValueOfTheSums) {
  const auto path = log_e_path(series, nights_of({{2, 1}, {-1, 3}, {4, 2}}), {0, 0});
  ASSERT_EQ(path.size(), 3U);
  EXPECT_EQ(path[0], stats::log_e_value({2, 1}, series.prior));
  EXPECT_EQ(path[1], stats::log_e_value({1, 4}, series.prior));
  EXPECT_EQ(path[2], stats::log_e_value({5, 6}, series.prior));
}

// The least E over the claimed values, found here on a grid of them.
TEST(LedgerReading, TheEValueOfARangeIsTheLeastOverIt) {
  for (const double score : {-9.0, -2.0, 0.5, 3.0, 40.0}) {
    const double information = 4;
    double least = infinity;
    for (int i = -100; i <= 100; ++i) {
      const double theta = 0.7 * i / 100;
      least = std::min(
          least, stats::log_e_value({score - information * theta, information}, series.prior));
    }
    const double found = log_e_path(series, nights_of({{score, information}}), {-0.7, 0.7})[0];
    EXPECT_LE(found, least + 1e-12) << score;
    EXPECT_NEAR(found, least, 1e-2) << score;
  }
}

TEST(LedgerReading, AnInequalityHasOneSide) {
  const auto e = [](double score, const ClaimedRange& range) {
    return log_e_path(series, nights_of({{score, 4}}), range)[0];
  };
  EXPECT_EQ(e(-9, {-infinity, 0}), e(0, {0, 0}));
  EXPECT_EQ(e(9, {-infinity, 0}), e(9, {0, 0}));
  EXPECT_EQ(e(9, {0, infinity}), e(0, {0, 0}));
}

TEST(LedgerReading, ClaimedRangesFollowTheRelation) {
  const auto range = [](Relation relation) {
    const ClaimedRange r = claimed_range({.relation = relation, .allow = 0.1, .within = 0.3});
    return std::pair(r.low, r.high);
  };
  EXPECT_EQ(range(Relation::equal), std::pair(-0.1, 0.1));
  EXPECT_EQ(range(Relation::at_most), std::pair(-infinity, 0.1));
  EXPECT_EQ(range(Relation::at_least), std::pair(-0.1, infinity));
  EXPECT_EQ(range(Relation::within), std::pair(-0.3, 0.3));
}

TEST(LedgerReading, EValuesMultiply) {
  const LedgerSeries law{.kind = EvidenceKind::log_e};
  const std::vector<LedgerNight> nights{{.log_e = -0.5}, {.log_e = 2}, {.log_e = 1}};
  EXPECT_EQ(log_e_path(law, nights, {0, 0}), (std::vector<double>{-0.5, 1.5, 2.5}));
  EXPECT_EQ(moved(law, nights).night, 1U);
}

TEST(LedgerReading, TellsWhenThetaMoved) {
  std::vector<stats::Evidence> evidence(10, {0, 1});
  evidence.resize(30, {1.5, 1});
  const Moved change = moved(series, nights_of(evidence));
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
