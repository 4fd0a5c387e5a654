#include "stats/laws/distribution_band.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <vector>

#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/means/binomial.h"
#include "stats/tails/tails.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

using tests::expect_calibrated;
using tests::expect_caught;
using tests::Experiment;
using tests::Philox;
using tests::Row;
using tests::sample_of;
using tests::Shape;
using tests::sorted;

TEST(DistributionBand, AgreesWithTransitionMatricesAtEveryStepOfGamma) {
  for (const Row& row : tests::read_table("band")) {
    SCOPED_TRACE(row.text("case"));
    DistributionBand band;
    if (row["case"] == 0) band = ecdf_band(20, 10, row["confidence"]);
    if (row["case"] == 1) band = ecdf_band(100, 100, row["confidence"]);
    if (row["case"] == 2) band = ecdf_band(TwoSizes{12, 15}, 9, row["confidence"]);
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

TEST(DistributionBand, OnePointIsABinomialInterval) {
  const std::vector<double> u{.1, .2, .25, .3, .31, .32, .4, .45, .49, .7};
  const BandTest result = band_test(u, 2);
  EXPECT_EQ(result.count, 9U);
  const double tail = std::exp(binomial_tails(9, {10, .5}).upper);
  EXPECT_NEAR(result.test.statistic, 2 * tail, 1e-12);
  EXPECT_NEAR(std::exp(result.test.log_p_upper), 2 * tail, 1e-12);
  EXPECT_EQ(result.worst.z, .5);
}

TEST(DistributionBand, FarTailsKeepTheirLogarithm) {
  const std::vector<double> u(5000, .001);
  const BandTest deep = band_test(u, 10);
  EXPECT_NEAR(deep.test.log_p_upper, 5000 * std::log(.1) + std::log(2 * 9), 1e-6);
  const std::vector<double> few(100, .001);
  const BandTest result = band_test(few, 10);
  // Only all or none of the values at either end are as unlikely: .1^100 twice.
  EXPECT_NEAR(result.test.log_p_upper, 100 * std::log(.1) + std::log(2), 1e-9);
}

TEST(DistributionBand, TheBandAndItsTestAgree) {
  const DistributionBand band = ecdf_band(50, 20, .9);
  Philox random(351);
  int outside = 0;
  for (int i = 0; i < 300; ++i) {
    const auto u = sorted(sample_of(50, [&] { return random.uniform(); }));
    bool left = false;
    for (const BandPoint& point : band.points) {
      const auto count =
          static_cast<std::uint64_t>(std::upper_bound(u.begin(), u.end(), point.z) - u.begin());
      left = left || count < point.low || count > point.high;
    }
    EXPECT_EQ(left, std::exp(band_test(u, 20).test.log_p_upper) <= 1 - band.coverage + 1e-9);
    outside += left;
  }
  EXPECT_GT(outside, 0);
}

TEST(DistributionBand, RefusesMalformedSamples) {
  EXPECT_THROW(ecdf_band(0, 10, .9), std::domain_error);
  EXPECT_THROW(ecdf_band(10, 1, .9), std::domain_error);
  EXPECT_THROW(ecdf_band(10, 10, 1), std::domain_error);
  EXPECT_THROW(ecdf_band(TwoSizes{0, 5}, 10, .9), std::domain_error);
  const std::vector<double> outside{.5, 1.5};
  const std::vector<double> unsorted{.5, .4};
  EXPECT_THROW(band_test(outside, 5), std::domain_error);
  EXPECT_THROW(band_test(unsorted, 5), std::domain_error);
  EXPECT_THROW(band_test({}, 5), std::domain_error);
}

TEST(DistributionBand, TwoConstantSamplesSayNothing) {
  const std::vector<double> same(10, 2.0);
  EXPECT_EQ(band_test(same, same, 10).test.log_p_upper, 0);
}

TEST(DistributionBand, OfOneSampleIsAtMostUniform) {
  expect_calibrated({352, 4000, Shape::at_most_uniform}, [](Philox& random) {
    const auto u = sorted(sample_of(60, [&] { return random.uniform(); }));
    return band_test(u, 30).test.log_p_upper;
  });
}

TEST(DistributionBand, OfALargeSampleIsNearlyUniform) {
  expect_calibrated({353, 2000, Shape::uniform}, [](Philox& random) {
    const auto u = sorted(sample_of(1000, [&] { return random.uniform(); }));
    return band_test(u, 30).test.log_p_upper;
  });
}

TEST(DistributionBand, OfTwoSamplesIsAtMostUniformWithAndWithoutTies) {
  expect_calibrated({354, 2000, Shape::at_most_uniform}, [](Philox& random) {
    const auto x = sorted(sample_of(40, [&] { return random.normal(); }));
    const auto y = sorted(sample_of(60, [&] { return random.normal(); }));
    return band_test(x, y, 20).test.log_p_upper;
  });
  expect_calibrated({355, 2000, Shape::at_most_uniform}, [](Philox& random) {
    const auto draw = [&] { return std::max(0.0, std::floor(4 * random.normal()) / 4); };
    const auto x = sorted(sample_of(40, draw));
    const auto y = sorted(sample_of(60, draw));
    return band_test(x, y, 20).test.log_p_upper;
  });
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

TEST(DistributionBand, APointwiseErrorTakenForThatOfTheBandIsCaught) {
  expect_caught({356, 4000, Shape::at_most_uniform}, [](Philox& random) {
    const auto u = sorted(sample_of(60, [&] { return random.uniform(); }));
    return std::log(band_test(u, 30).test.statistic);
  });
}

TEST(DistributionBand, ABinomialInPlaceOfTheHypergeometricIsCaught) {
  // The mutant holds x of a pooled sample against the law of independent uniforms. It is too good
  // to be true.
  expect_caught({357, 4000, Shape::uniform}, [](Philox& random) {
    const auto x = sorted(sample_of(300, [&] { return random.uniform(); }));
    const auto y = sorted(sample_of(300, [&] { return random.uniform(); }));
    std::vector<double> ranks;
    for (std::size_t i = 0; i < 300; ++i) {
      const auto among = std::upper_bound(y.begin(), y.end(), x[i]) - y.begin();
      ranks.push_back((static_cast<double>(i) + 1 + static_cast<double>(among)) / 601);
    }
    return band_test(ranks, 20).test.log_p_upper;
  });
}

// Three in a hundred values are moved to the last hundredth of the law. The band sees that,
// Kolmogorov and Smirnov's distance does not. Measured powers are .985 and .028; Hoeffding at 1e-5,
// R = 400: .12.
TEST(DistributionBand, FindsWhatHappensInTheTail) {
  Philox random(358);
  const ContinuousLaw uniform{[](double x) { return x; }};
  int found = 0;
  int by_distance = 0;
  for (int i = 0; i < 400; ++i) {
    const auto u = sorted(sample_of(1000, [&] {
      const double v = random.uniform();
      return random.uniform() < .03 ? .99 + .01 * v : v;
    }));
    found += band_test(u, 100).test.log_p_upper <= std::log(1e-3);
    by_distance += kolmogorov_smirnov(ks_distance(u, uniform)).log_p_upper <= std::log(1e-3);
  }
  std::cout << "  found " << found / 400.0 << ", by the distance " << by_distance / 400.0 << "\n";
  EXPECT_GE(found / 400.0, .985 - .12);
  EXPECT_LE(by_distance / 400.0, .028 + .12);
}

}  // namespace
}  // namespace assay::stats
