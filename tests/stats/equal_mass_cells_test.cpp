#include "stats/equal_mass_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numeric>
#include <vector>

#include "tests/stats/calibration.h"

namespace assay::stats {
namespace {

using tests::calibrate;
using tests::Experiment;
using tests::Philox;

// Density 4 a b: mass a^2 b^2 below (a, b).
double product(SquarePoint p) { return 4 * p.a * p.b; }

const CellPlan plan{.observations = 2000, .most_cells = 40, .resolution = 32};

TEST(EqualMassCells, EveryCellHasItsMassAndTheFloor) {
  const EqualMassCells grid = equal_mass_cells(product, plan);
  ASSERT_GE(grid.size(), 20U);
  ASSERT_LE(grid.size(), 40U);
  EXPECT_NEAR(grid.cells.total, 1, 1e-9);
  const auto square = [](double x) { return x * x; };
  std::size_t cell = 0;
  for (std::size_t i = 0; i < grid.cut_edges.size(); ++i) {
    const double band = square(grid.band_edges[i + 1]) - square(grid.band_edges[i]);
    for (std::size_t j = 0; j + 1 < grid.cut_edges[i].size(); ++j, ++cell) {
      const double cut = square(grid.cut_edges[i][j + 1]) - square(grid.cut_edges[i][j]);
      EXPECT_NEAR(grid.cells.probability[cell], band * cut, 1e-10);
      EXPECT_GE(2000 * grid.cells.probability[cell], 20);
      const double a = (grid.band_edges[i] + grid.band_edges[i + 1]) / 2;
      const double b = (grid.cut_edges[i][j] + grid.cut_edges[i][j + 1]) / 2;
      EXPECT_EQ(grid.index({a, b}), cell);
    }
  }
  EXPECT_EQ(cell, grid.size());
  EXPECT_EQ(grid.index({1, 1}), grid.size() - 1);
}

TEST(EqualMassCells, TheTriangleMapsToTheSquareAndBack) {
  const SquarePoint p{.3, .8};
  const Barycentric t = triangle_point(p);
  EXPECT_NEAR(t.first + t.second + t.third, 1, 1e-15);
  EXPECT_NEAR(square_point(t).a, .3, 1e-15);
  EXPECT_NEAR(square_point(t).b, .8, 1e-15);
}

TEST(EqualMassCells, ADensityThatDoesNotIntegrateToOneSaysSo) {
  const auto grid = equal_mass_cells([](SquarePoint p) { return .9 * product(p); }, plan);
  EXPECT_NEAR(grid.cells.total, .9, 1e-9);
  EXPECT_LT(grid.cells.total_error, 1e-6);
}

TEST(EqualMassCells, RefusesMalformedDensities) {
  EXPECT_THROW(equal_mass_cells([](SquarePoint) { return -1.0; }, plan), std::domain_error);
  EXPECT_THROW(equal_mass_cells([](SquarePoint) { return 0.0; }, plan), std::domain_error);
  EXPECT_THROW(equal_mass_cells(product, {.observations = 0}), std::domain_error);
  EXPECT_THROW(equal_mass_cells(product, plan).index({1.5, 0}), std::domain_error);
}

TEST(EqualMassCells, IntervalsOfADensityHaveTheirMass) {
  const auto grid = equal_mass_intervals([](double x) { return x / 2; }, {0, 2, 256}, plan);
  EXPECT_GE(grid.size(), 30U);
  EXPECT_LE(grid.size(), 40U);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double low = grid.edges[i];
    const double high = grid.edges[i + 1];
    EXPECT_NEAR(grid.cells.probability[i], (high * high - low * low) / 4, 1e-12);
    EXPECT_GE(grid.cells.probability[i], .025);
    EXPECT_EQ(grid.index((low + high) / 2), i);
  }
  EXPECT_THROW(grid.index(2.1), std::domain_error);
}

CellObservations draw(Philox& random, const EqualMassCells& grid, double power) {
  CellObservations counts{std::vector<std::uint64_t>(grid.size())};
  for (int i = 0; i < 2000; ++i) {
    const double a = std::pow(random.uniform(), 1 / power);
    ++counts.observed[grid.index({a, std::sqrt(random.uniform())})];
  }
  return counts;
}

// False alarm 1e-5 (tests/stats/calibration.h).
TEST(EqualMassCells, TheFitIsCalibratedAndAWrongDensityIsCaught) {
  const EqualMassCells grid = equal_mass_cells(product, plan);
  const auto right = calibrate(Experiment{381, 3000}, [&](Philox& random) {
    return chi_square_fit(grid.cells, draw(random, grid, 2)).test.log_p_upper;
  });
  EXPECT_TRUE(right.ok) << right.text();
  std::cout << "  3000 repetitions: " << right.text() << "\n";
  const auto wrong = calibrate(Experiment{382, 1000}, [&](Philox& random) {
    return chi_square_fit(grid.cells, draw(random, grid, 1.8)).test.log_p_upper;
  });
  EXPECT_FALSE(wrong.ok) << wrong.text();
}

TEST(EqualMassCells, AnErrorOfTheQuadratureRaisesP) {
  EqualMassCells grid = equal_mass_cells(product, plan);
  Philox random(383);
  const CellObservations counts = draw(random, grid, 1.8);
  const double sharp = chi_square_fit(grid.cells, counts).test.log_p_upper;
  for (double& error : grid.cells.error) error = .002;
  EXPECT_GT(chi_square_fit(grid.cells, counts).test.log_p_upper, sharp);
  for (double& error : grid.cells.error) error = 1;
  EXPECT_GT(chi_square_fit(grid.cells, counts).test.log_p_upper, std::log(.5));
}

}  // namespace
}  // namespace assay::stats
