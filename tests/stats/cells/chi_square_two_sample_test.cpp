#include "stats/cells/chi_square.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// scipy.stats.chi2_contingency([x, y], correction=False); ncx2.sf(X2, 4, w^2 m n / (m + n)) and cdf
// at w = .1 and .2, scipy 1.10.
TEST(ChiSquareTwoSample, AgreesWithScipy) {
  const ChiSquareTwoSample same =
      chi_square_two_sample({{48, 75, 31, 62, 90}, {102, 141, 49, 150, 158}});
  EXPECT_NEAR(same.test.statistic, 3.829401498434634, 1e-12);
  EXPECT_NEAR(std::exp(same.test.log_p_upper), 0.42958588450909707, 1e-13);
  EXPECT_EQ(same.statistic.degrees_of_freedom, 4);
  const ChiSquareTwoSample apart =
      chi_square_two_sample({{480, 750, 310, 620, 900}, {402, 641, 349, 750, 958}});
  EXPECT_NEAR(apart.test.statistic, 31.635247900860254, 1e-11);
  EXPECT_NEAR(apart.test.log_p_upper, -12.995196569215292, 1e-11);
  EXPECT_NEAR(std::exp(chi_square_effect(apart.statistic, .1).log_p_upper), 0.08368555627523609,
              1e-11);
  EXPECT_NEAR(std::exp(chi_square_effect(apart.statistic, .2).log_p_lower), 0.0071515997157314245,
              1e-11);
}

TEST(ChiSquareTwoSample, PoolsByTheTotalsAloneAndSkipsCellsThatNobodyHit) {
  // 20 expected of each side: 40 of both.
  const ChiSquareTwoSample fit =
      chi_square_two_sample({{30, 0, 10, 5, 60, 0, 9}, {20, 0, 10, 25, 50, 0, 0}});
  ASSERT_EQ(fit.cells.size(), 3U);
  EXPECT_EQ(fit.cells[0].members, (std::vector<std::size_t>{0}));
  EXPECT_EQ(fit.cells[1].members, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(fit.cells[2].members, (std::vector<std::size_t>{4, 6})) << "the rest joins the last";
  EXPECT_EQ(fit.cells[2].x, 69U);
  EXPECT_EQ(fit.statistic.degrees_of_freedom, 2);
  // With unequal sizes the smaller decides: 20 of 100 beside 1000 are 220 of both.
  EXPECT_EQ(chi_square_two_sample({{50, 50}, {180, 820}}).cells.size(), 2U);
}

std::vector<PlanePoint> square(Philox& random, std::size_t n) {
  std::vector<PlanePoint> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = random.uniform();
    points.push_back({u, random.uniform()});
  }
  return points;
}

TEST(SampledCells, HoldEqualNumbersOfTheirPoints) {
  Philox random(381);
  const auto points = square(random, 4096);
  const SampledCells cells = sampled_cells(points, {.bands = 8, .cuts = 4});
  ASSERT_EQ(cells.size(), 32U);
  std::vector<int> counts(32);
  for (const PlanePoint& point : points) ++counts[cells.index(point)];
  for (const int count : counts) EXPECT_NEAR(count, 128, 1);
  EXPECT_EQ(cells.index({-1e300, -1e300}), 0U) << "the outermost cells have no end";
  EXPECT_EQ(cells.index({1e300, 1e300}), 31U);
}

TEST(SampledCells, OfOneCoordinateAndOfRepeatedValuesAreFewer) {
  const SampledCells line =
      sampled_cells({{1, 0}, {2, 0}, {3, 0}, {4, 0}}, {.bands = 4, .cuts = 4});
  EXPECT_EQ(line.size(), 4U);
  EXPECT_EQ(line.index({2, 0}), 1U) << "a value on a border is in the upper cell";
  const SampledCells atoms =
      sampled_cells({{0, 0}, {0, 0}, {0, 0}, {1, 0}}, {.bands = 4, .cuts = 1});
  EXPECT_EQ(atoms.size(), 2U);
}

ChiSquareTwoSample compared(const SampledCells& cells, const std::vector<PlanePoint>& x,
                            const std::vector<PlanePoint>& y) {
  TwoSampleCounts counts{std::vector<std::uint64_t>(cells.size()),
                         std::vector<std::uint64_t>(cells.size())};
  for (const PlanePoint& point : x) ++counts.x[cells.index(point)];
  for (const PlanePoint& point : y) ++counts.y[cells.index(point)];
  return chi_square_two_sample(counts);
}

const SampledCells& cells_of_pilot() {
  static const SampledCells cells = [] {
    Philox pilot(382);
    return sampled_cells(square(pilot, 2048), {.bands = 4, .cuts = 4});
  }();
  return cells;
}

// Asymptotic and discrete, at 31 expected in a cell: held to at most the nominal level.
CALIBRATED(ChiSquareTwoSample, InCellsOfAPilotIsCalibrated, 383, 4000, Shape::at_most_uniform) {
  const auto x = square(random, 500);
  return compared(cells_of_pilot(), x, square(random, 500)).test.log_p_upper;
}

// Cells from the values of both together. Neither side is told from the other.
CALIBRATED(ChiSquareTwoSample, InCellsOfBothSamplesTogetherIsCalibrated, 384, 4000,
           Shape::at_most_uniform) {
  const auto x = square(random, 500);
  const auto y = square(random, 500);
  auto both = x;
  both.insert(both.end(), y.begin(), y.end());
  return compared(sampled_cells(both, {.bands = 4, .cuts = 4}), x, y).test.log_p_upper;
}

// The mutant takes one sample for exact: variance 1/m instead of 1/m + 1/n.
CAUGHT(ChiSquareTwoSample, OneSampleTakenForTheTruthIsCaught, 387, 2000, Shape::at_most_uniform) {
  const auto x = square(random, 500);
  auto doubled = compared(cells_of_pilot(), x, square(random, 500)).statistic;
  doubled.value *= 2;
  return chi_square_effect(doubled, 0).log_p_upper;
}

}  // namespace
}  // namespace assay::stats
