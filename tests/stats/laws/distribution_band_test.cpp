#include "stats/laws/distribution_band.h"

#include "stats/means/binomial.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(DistributionBand, AgreesWithTransitionMatricesAtEveryStepOfGamma) {
  for (const Row& row : tests::read_table("band")) {
    SCOPED_TRACE(row.text("case"));
    DistributionBand band;
    if (row["case"] == 0) band = ecdf_band(20, 10, row["confidence"]);
    if (row["case"] == 1) band = ecdf_band(100, 100, row["confidence"]);
    EXPECT_NEAR(band.coverage, row["coverage"], 1e-10);
    EXPECT_GE(band.gamma, row["step"] * (1 - 1e-9));
    EXPECT_NEAR(band.gamma / row["next_step"], 1, 3e-6);
  }
}

// Published for this band: gamma about .0041 at n = 100, 100 points, .95.
TEST(DistributionBand, OfAHundredValuesHasTheKnownGamma) {
  const DistributionBand band = ecdf_band(100, 100, .95);
  EXPECT_NEAR(band.gamma, .0041, 5e-5);
  ASSERT_EQ(band.points.size(), 99U);
  EXPECT_EQ(band.points[49].low, 36U);
  EXPECT_EQ(band.points[49].high, 64U);
  for (std::size_t i = 0; i < 99; ++i) {
    EXPECT_EQ(band.points[i].low, 100 - band.points[98 - i].high);
  }
}

// Hoeffding's bound at 1e-5, R = 4000: .0391. The coverage is exact.
TEST(DistributionBand, HoldsAWholePathAsOftenAsItSays) {
  const DistributionBand band = ecdf_band(50, 20, .9);
  Philox random(351);
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto u = sorted(sample_of(50, [&] { return random.uniform(); }));
    inside += std::all_of(band.points.begin(), band.points.end(), [&](const BandPoint& point) {
      const auto count =
          static_cast<std::uint64_t>(std::upper_bound(u.begin(), u.end(), point.z) - u.begin());
      return count >= point.low && count <= point.high;
    });
  }
  EXPECT_GE(band.coverage, .9);
  EXPECT_NEAR(inside / 4000.0, band.coverage, .0391);
}

/// The share of runs in which intervals at this pointwise error do not all hold the law. They stand
/// at 63 order statistics of n uniform values.
double exits(std::uint32_t test_case, std::uint64_t n, double gamma, std::size_t runs) {
  std::vector<std::pair<std::uint64_t, Interval>> bands;
  for (std::uint64_t i = 1; i < 64; ++i) {
    bands.emplace_back(i * n / 64, clopper_pearson({i * n / 64, n}, 1 - gamma));
  }
  Philox random(test_case);
  std::size_t left = 0;
  for (std::size_t run = 0; run < runs; ++run) {
    const auto u = sorted(sample_of(n, [&] { return random.uniform(); }));
    left += std::any_of(bands.begin(), bands.end(), [&](const auto& band) {
      const double law = u[band.first - 1];
      return law < band.second.low || law > band.second.high;
    });
  }
  return static_cast<double>(left) / static_cast<double>(runs);
}

// Intervals around an empirical distribution function. Exact at n = 200, by the limit at n = 5000.
TEST(DistributionBand, IntervalsAtItsErrorHoldTheLawEverywhere) {
  const double exact = exits(371, 200, simultaneous_error(200, 64, .95), 4000);
  EXPECT_FALSE(tests::too_many(exact, .05, 4000)) << exact;
  EXPECT_GT(exact, .02) << "nor are they idle";
  const double limit = exits(372, 5000, simultaneous_error(5000, 64, .95), 2000);
  EXPECT_FALSE(tests::too_many(limit, .05, 2000)) << limit;
  EXPECT_GT(limit, .02);
  EXPECT_TRUE(tests::too_many(exits(373, 200, .05, 1000), .05, 1000)) << "pointwise ones do not";
}

// Exact values at .99: 4.763694e-4 at n = 5000, 4.432e-4 at 1e5.
TEST(DistributionBand, ErrorOfManyValuesIsNoLargerThanTheExactOne) {
  const double limit = simultaneous_error(1'000'000, 64, .99);
  EXPECT_LT(limit, 4.432e-4);
  EXPECT_GT(limit, .95 * 4.432e-4);
}

}  // namespace
}  // namespace assay::stats
