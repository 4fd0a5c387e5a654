#include "tests/stats/point_by_point.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

/// The grid's own cells.
CellProbabilities cell_probabilities(const PlaneGrid& grid, const PlaneDensity& density,
                                     QuadratureLimits limits = {.tolerance = 1e-9}) {
  return adaptive_cells(grid, density, 1, limits).mass;
}

TEST(PlaneCells, IndicesRunFastestInY) {
  const PlaneGrid grid = unit_grid(4, 4);
  EXPECT_EQ(grid.index(0, 0), 0U);
  EXPECT_EQ(grid.index(0, .3), 1U);
  EXPECT_EQ(grid.index(.25, 0), 4U) << "a border belongs to the cell above it";
  EXPECT_EQ(grid.index(1, 1), 15U) << "but the last one";
}

TEST(PlaneCells, ASmoothDensityIsAskedForInFewQuestions) {
  std::size_t questions = 0;
  std::size_t places = 0;
  const PlaneDensity flat{.x = {0, 1}, .y = {0, 1}, .values = [&](auto x, auto, auto values) {
                            ++questions;
                            places += x.size();
                            std::ranges::fill(values, 1.0);
                          }};
  cell_probabilities(unit_grid(4, 4), flat);
  EXPECT_EQ(places, 16u * 27 * 27);
  EXPECT_EQ(questions, 16u * 3 * 2) << "a part and its halves: along nine lines, and their halves";
}

// A disc of radius r about the middle, density 1 / (pi r^2), jumps along a curve. The four middle
// cells of 4 x 4 hold a quarter each but for the caps beyond them.
TEST(PlaneCells, AJumpAlongACurveIsFoundWithinItsErrorAndTheLimit) {
  constexpr double r = .22;
  const PlaneGrid grid = unit_grid(4, 4);
  std::uint64_t evaluations = 0;
  const PlaneDensity disc = on_unit_square([&](double x, double y) {
    ++evaluations;
    return std::hypot(x - .5, y - .5) < r ? 1 / (pi * r * r) : 0;
  });
  const CellProbabilities cells =
      cell_probabilities(grid, disc, {.tolerance = 1e-9, .evaluations = 5'000'000});
  EXPECT_NEAR(cells.probability[grid.index(.4, .4)], .25, 1e-7);
  EXPECT_NEAR(cells.total, 1, cells.total_error);
  EXPECT_LT(cells.total_error, 2e-4) << "next to the disc a corner may hide";
  EXPECT_LT(evaluations, 6'000'000U);
}

// The corner of a square reaches 1/100 of a cell beyond its border, between the outermost nodes.
TEST(PlaneCells, ACornerOfTheSupportIsFoundInTheNextCell) {
  constexpr double tip = .2525;
  const PlaneGrid grid = unit_grid(4, 4);
  const PlaneDensity wedge =
      on_unit_square([](double x, double y) { return x + std::abs(y - .135) < tip ? 1.0 : 0; });
  const CellProbabilities cells = cell_probabilities(grid, wedge);
  const std::size_t next = grid.index(.26, .135);
  const double hidden = (tip - .25) * (tip - .25);
  EXPECT_NEAR(cells.probability[next], hidden, 0.01 * hidden);
  EXPECT_LE(std::abs(cells.probability[next] - hidden), cells.error[next]);
}

TEST(PlaneCells, ACellThatMayHideACornerSaysSo) {
  const PlaneGrid grid = unit_grid(4, 4);
  const CellProbabilities cells = cell_probabilities(
      grid, on_unit_square([](double x, double y) { return x < .25 && y < .25 ? 16.0 : 0; }));
  EXPECT_EQ(cells.probability[grid.index(.3, .1)], 0);
  EXPECT_GT(cells.error[grid.index(.3, .1)], 0);
  EXPECT_EQ(cells.error[grid.index(.6, .6)], 0) << "far from the support";
}

// A block, and to its right a spike thinner than the panels, across several cells. Each part is
// found beside the last, none by the nodes.
TEST(PlaneCells, ASupportIsFollowedFromCellToCell) {
  constexpr double y0 = .57412;
  constexpr double half_width = .00274;
  constexpr double length = .4256;
  const auto density = [](double x, double y) {
    const double along = (x - .25) / length;
    const bool spike =
        along >= 0 && along < 1 && std::abs(y - y0 + .00113 * (x - .25)) < half_width * (1 - along);
    return x < .25 || spike ? 1.0 : 0.0;
  };
  const CellProbabilities cells =
      cell_probabilities(unit_grid(8, 8), on_unit_square(density, {8}), {.tolerance = 1e-8});
  EXPECT_NEAR(cells.total, .25 + half_width * length, cells.total_error);
  EXPECT_LT(cells.total_error, 2e-4);
}

// 1500 exp(-1500 x) underflows halfway across. The cells beyond may hide density as great as what
// ends before them. That is less than the peak.
TEST(PlaneCells, WhatUnderflowsHidesNoPeak) {
  const PlaneGrid grid = unit_grid(8, 8);
  const auto peak = [](double x, double) { return 1500 * std::exp(-1500 * x); };
  const CellProbabilities cells = cell_probabilities(grid, on_unit_square(peak, {8}));
  ASSERT_EQ(cells.probability[grid.index(.7, .1)], 0);
  EXPECT_NEAR(cells.total, 1, 1e-8);
  EXPECT_LT(cells.total_error, 1e-7);
}

TEST(PlaneCells, AJumpAlongALineAnywhereIsFoundWithinItsError) {
  const PlaneGrid grid = unit_grid(8, 8);
  for (int k = 1; k < 40; ++k) {
    const double place = std::fmod(.6180339887498949 * k, 1);
    for (const bool along_x : {true, false}) {
      const auto jump = [&](double x, double y) { return (along_x ? y : x) < place ? 2.0 : .5; };
      const CellProbabilities cells =
          cell_probabilities(grid, on_unit_square(jump), {.tolerance = 1e-8});
      EXPECT_NEAR(cells.total, 2 * place + .5 * (1 - place), cells.total_error) << place;
      EXPECT_LT(cells.total_error, 1e-6);
    }
  }
}

TEST(PlaneCells, JumpsOnPanelBordersCostNothing) {
  std::uint64_t evaluations = 0;
  PlaneDensity board = on_unit_square([&](double x, double y) {
    ++evaluations;
    return int(x * 10) % 2 == int(y * 6) % 2 ? 2.0 : 0;
  });
  board.x_panels = {10};
  board.y_panels = {6};
  const CellProbabilities cells = cell_probabilities(unit_grid(4, 4), board);
  EXPECT_NEAR(cells.total, 1, 1e-12);
  EXPECT_LT(evaluations, 400'000U);
}

}  // namespace
}  // namespace assay::stats
