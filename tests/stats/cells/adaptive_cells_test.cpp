#include "stats/cells/adaptive_cells.h"

#include "stats/cells/chi_square_fit.h"
#include "tests/prelude.h"
#include "tests/stats/calibration.h"
#include "tests/stats/point_by_point.h"

namespace assay::stats {
namespace {

std::vector<double> even(std::size_t cells) {
  std::vector<double> borders;
  for (std::size_t k = 0; k <= cells; ++k) {
    borders.push_back(static_cast<double>(k) / static_cast<double>(cells));
  }
  return borders;
}

PlaneGrid unit_grid(std::size_t rows, std::size_t columns) { return {even(rows), even(columns)}; }

PlaneDensity on_unit_square(auto density) {
  return {.x = {0, 1}, .y = {0, 1}, .values = point_by_point(density)};
}

void expect_a_partition(const HalvedCells& cells) {
  double area = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const PlaneCell& cell = cells.cells[i];
    area += cell.x.width() * cell.y.width();
    EXPECT_EQ(cells.index(cell.x.middle(), cell.y.middle()), i);
    EXPECT_EQ(cells.index(cell.x.low, cell.y.low), i) << "closed below";
    EXPECT_EQ(cells.grid.index(cell.x.middle(), cell.y.middle()), cells.grid_cells[i]);
  }
  EXPECT_NEAR(area, 1, 1e-12);
}

// The law 4 x y gives a cell the product of the differences of squares.
TEST(AdaptiveCells, EveryCellHasItsMassAndNoMoreThanItsShare) {
  const auto found = adaptive_cells(
      unit_grid(4, 4), on_unit_square([](double x, double y) { return 4 * x * y; }), 1.0 / 64);
  const auto below = [](const Span& s) { return s.high * s.high - s.low * s.low; };
  for (std::size_t i = 0; i < found.cells.size(); ++i) {
    const PlaneCell& cell = found.cells.cells[i];
    EXPECT_NEAR(found.mass.probability[i], below(cell.x) * below(cell.y), 1e-12);
    EXPECT_LE(found.mass.probability[i], 1.0 / 64);
  }
  EXPECT_NEAR(found.mass.total, 1, 1e-12);
  // One cell of the grid has (7/16)^2 of the mass and needs 16 parts; another has (1/16)^2.
  EXPECT_GT(found.cells.size(), 64U);
  EXPECT_LT(found.cells.size(), 160U);
  expect_a_partition(found.cells);
}

TEST(AdaptiveCells, AnEvenDensityIsLeftInTheGridsCells) {
  const auto found =
      adaptive_cells(unit_grid(3, 5), on_unit_square([](double, double) { return .25; }), 2.0 / 15);
  ASSERT_EQ(found.cells.size(), 15U);
  for (const double mass : found.mass.probability) EXPECT_NEAR(mass, .25 / 15, 1e-15);
  EXPECT_TRUE(found.cells.halves.empty());
  expect_a_partition(found.cells);
}

TEST(AdaptiveCells, OneLobeOfSeveralHasItsShareOfOne) {
  const auto part = [](double mass) {
    const auto peak = [mass](double x, double) { return mass * 3 * x * x; };
    return adaptive_cells(unit_grid(4, 4), on_unit_square(peak), 1.0 / 16).cells.size();
  };
  EXPECT_EQ(part(.1), 16U) << "no cell has a sixteenth of 1";
  EXPECT_GT(part(1), 20U);
  EXPECT_EQ(part(10), part(1)) << "a density that is none gets no more cells than one";
}

/// A normal law of this deviation about a point. All but 1e-9 of it is on the square.
struct Peak {
  double x;
  double y;
  double deviation;

  double operator()(double u, double v) const {
    const double r2 = ((u - x) * (u - x) + (v - y) * (v - y)) / (deviation * deviation);
    return std::exp(-r2 / 2) / (2 * std::numbers::pi * deviation * deviation);
  }
};

double normal_mass(Span span, double mean, double deviation) {
  const double root = std::sqrt(2) * deviation;
  return (std::erf((span.high - mean) / root) - std::erf((span.low - mean) / root)) / 2;
}

constexpr Peak narrow{.x = .4, .y = .7, .deviation = .004};

PlaneDensity density_of(const Peak& peak) {
  PlaneDensity density = on_unit_square(peak);
  density.x_panels = density.y_panels = {100};
  return density;
}

TEST(AdaptiveCells, ANarrowPeakIsCountedInManyCells) {
  const auto found = adaptive_cells(unit_grid(16, 32), density_of(narrow), 1.0 / 256);
  std::size_t held = 0;
  for (std::size_t i = 0; i < found.cells.size(); ++i) {
    const PlaneCell& cell = found.cells.cells[i];
    const double mass = normal_mass(cell.x, narrow.x, narrow.deviation) *
                        normal_mass(cell.y, narrow.y, narrow.deviation);
    EXPECT_NEAR(found.mass.probability[i], mass, 1e-7);
    EXPECT_LE(found.mass.probability[i], 1.0 / 256);
    held += mass > 1.0 / 2048 ? 1 : 0;
  }
  EXPECT_GT(held, 256U);
  EXPECT_LT(found.cells.size(), 1600U);
  expect_a_partition(found.cells);
}

/// Counts of points of a peak of another deviation.
CellCounts counts_of(Philox& random, const AdaptiveCells& found, double deviation) {
  CellCounts counts{.observed = std::vector<std::uint64_t>(found.cells.size()),
                    .probability = found.mass.probability,
                    .error = found.mass.error};
  for (int i = 0; i < 4000; ++i) {
    const double radius = deviation * std::sqrt(-2 * std::log1p(-random.uniform()));
    const double angle = 2 * std::numbers::pi * random.uniform();
    ++counts.observed[found.cells.index(narrow.x + radius * std::cos(angle),
                                        narrow.y + radius * std::sin(angle))];
  }
  return counts;
}

// Four thousand points of a peak a fifth too wide. One of the grid's own cells holds nearly all of
// it, so the grid can test nothing. False alarm 1e-5 (tests/stats/calibration.h).
TEST(AdaptiveCells, TheirFitIsCalibratedAndFindsAWrongWidthThatTheGridCannot) {
  const auto cells = [](double share) {
    return adaptive_cells(unit_grid(16, 32), density_of(narrow), share);
  };
  const AdaptiveCells fine = cells(1.0 / 256);
  const AdaptiveCells coarse = cells(1);
  const auto fit = [&](const AdaptiveCells& found, double wider) {
    return [&found, wider](Philox& random) {
      const CellCounts counts = counts_of(random, found, wider * narrow.deviation);
      return chi_square_fit(counts, {.probability_tolerance = 1e-6}).test.log_p_upper;
    };
  };
  const auto right = calibrate(Experiment{381, tests::repetitions(3000)}, fit(fine, 1));
  EXPECT_TRUE(right.ok) << right.text();
  std::cout << "  " << tests::repetitions(3000) << " repetitions: " << right.text() << "\n";
  const auto wrong = calibrate(Experiment{382, tests::repetitions(1000)}, fit(fine, 1.2));
  EXPECT_FALSE(wrong.ok) << wrong.text();
  std::cout << "  a fifth too wide: " << wrong.text() << "\n";
  Philox random(383);
  EXPECT_THROW(fit(coarse, 1)(random), std::domain_error) << "one pool";
}

// A ridge along y is cut across until it is as wide as its cell, and never along y.
TEST(AdaptiveCells, ARidgeIsCutAcross) {
  const auto ridge = [](double x, double) {
    return std::exp(-(x - .3) * (x - .3) / 2e-4) / std::sqrt(2e-4 * std::numbers::pi);
  };
  PlaneDensity density = on_unit_square(ridge);
  density.x_panels = {100};
  const auto found = adaptive_cells(unit_grid(2, 4), density, 1.0 / 16);
  for (std::size_t i = 0; i < found.cells.size(); ++i) {
    EXPECT_GE(found.cells.cells[i].y.width(), 1.0 / 16) << "in turn it would be 1/64";
    if (found.mass.probability[i] <= 1.0 / 64) continue;
    EXPECT_LE(found.cells.cells[i].x.width(), 1.0 / 16);
  }
  EXPECT_NEAR(found.mass.total, 1, 1e-9);
  EXPECT_LE(*std::ranges::max_element(found.mass.probability), 1.0 / 16);
}

// Nearly all mass is on one double. Its cell is halved until no number lies between its ends, or 48
// times.
TEST(AdaptiveCells, ACellIsNotHalvedIntoNothing) {
  const double spike = .3;
  const auto at = [&](std::span<const double> x, std::span<double> values) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      values[i] = 1 / (std::abs(x[i] - spike) + 1e-18) / 80;
    }
  };
  const auto found = adaptive_cells(even(4), {.values = at}, 1.0 / 64, {.tolerance = 1e-3});
  for (const PlaneCell& cell : found.cells.cells) EXPECT_LT(cell.x.low, cell.x.high);
  const auto tiny = adaptive_cells({1e9, std::nextafter(1e9, 2e9)}, {.values = at}, 1.0 / 64,
                                   {.tolerance = 1e-3});
  EXPECT_EQ(tiny.cells.size(), 1U) << "nothing lies between two neighbours";
}

// A disc within a few cells of the grid: it jumps along a curve.
TEST(AdaptiveCells, AJumpAlongACurveStaysWithinItsErrors) {
  constexpr double r = .03;
  const auto disc = [&](double x, double y) {
    return std::hypot(x - .43, y - .57) < r ? 1 / (std::numbers::pi * r * r) : 0.0;
  };
  PlaneDensity density = on_unit_square(disc);
  density.x_panels = density.y_panels = {32};
  const auto found = adaptive_cells(unit_grid(16, 16), density, 1.0 / 64, {.tolerance = 1e-6});
  EXPECT_NEAR(found.mass.total, 1, found.mass.total_error);
  EXPECT_LT(found.mass.total_error, 1e-3);
  EXPECT_LE(*std::ranges::max_element(found.mass.probability), 1.0 / 64);
  expect_a_partition(found.cells);
}

// A peak of 2e-5 by 3e-5 lies between the nodes of every cell, and between its looks for the side.
TEST(AdaptiveCells, DrawsLeadToPeaksThatNoNodeMeets) {
  const auto normal = [](double x, double mean, double deviation) {
    const double z = (x - mean) / deviation;
    return std::exp(-z * z / 2) / (deviation * std::sqrt(2 * std::numbers::pi));
  };
  PlaneDensity density = on_unit_square(
      [&](double x, double y) { return normal(x, .3456789, 2e-5) * normal(y, .7, 3e-5); });
  const QuadratureLimits limits{.tolerance = 1e-8};
  EXPECT_LT(adaptive_cells(unit_grid(16, 32), density, 1.0 / 40, limits).mass.total, 1e-6);
  Philox random(31);
  std::array<std::vector<double>, 2> places;
  for (int i = 0; i < 4096; ++i) {
    density.drawn.push_back({.3456789 + 2e-5 * random.normal(), .7 + 3e-5 * random.normal()});
    for (std::size_t k = 0; k < 2; ++k) places[k].push_back(density.drawn.back()[k]);
  }
  density.x_panels.borders = borders_of_peaks(places[0], density.x);
  density.y_panels.borders = borders_of_peaks(places[1], density.y);
  const auto found = adaptive_cells(unit_grid(16, 32), density, 1.0 / 40, limits);
  EXPECT_NEAR(found.mass.total, 1, 1e-6);
  EXPECT_LE(*std::ranges::max_element(found.mass.probability), 1.0 / 40);
  expect_a_partition(found.cells);
}

TEST(AdaptiveCells, WithoutEvaluationsACellStaysWhole) {
  std::uint64_t evaluations = 0;
  const auto counted = [&](double x, double y) {
    ++evaluations;
    return narrow(x, y);
  };
  PlaneDensity density = on_unit_square(counted);
  density.x_panels = density.y_panels = {100};
  const QuadratureLimits enough{.tolerance = 1e-8};
  adaptive_cells(unit_grid(4, 4), density, 1, enough);
  const QuadratureLimits limits{.tolerance = 1e-8, .evaluations = evaluations + 20000};
  const auto some = adaptive_cells(unit_grid(4, 4), density, 1.0 / 256, limits);
  const auto all = adaptive_cells(unit_grid(4, 4), density, 1.0 / 256, enough);
  EXPECT_LT(some.cells.size(), all.cells.size());
  EXPECT_NEAR(some.mass.total, 1, 1e-6);
  expect_a_partition(some.cells);
}

TEST(AdaptiveCells, PartsOfAnIntervalHaveTheirMass) {
  const LineDensity density{.values = [](std::span<const double> x, std::span<double> values) {
    for (std::size_t i = 0; i < x.size(); ++i) values[i] = 50 * std::exp(-50 * x[i]);
  }};
  const auto found = adaptive_cells(even(64), density, 1.0 / 32);
  for (std::size_t i = 0; i < found.cells.size(); ++i) {
    const Span& part = found.cells.cells[i].x;
    EXPECT_NEAR(found.mass.probability[i], std::exp(-50 * part.low) - std::exp(-50 * part.high),
                1e-12);
    EXPECT_LE(found.mass.probability[i], 1.0 / 32);
  }
  EXPECT_GT(found.cells.size(), 64U + 30);
  expect_a_partition(found.cells);
}

TEST(AdaptiveCells, RefusesWhatIsNoDensityAndNoShare) {
  const PlaneGrid grid = unit_grid(2, 2);
  const auto flat = on_unit_square([](double, double) { return 1.0; });
  EXPECT_THROW(adaptive_cells(grid, on_unit_square([](double, double) { return -1.0; }), 1),
               std::domain_error);
  EXPECT_THROW(adaptive_cells(grid, flat, 0), std::domain_error);
  EXPECT_THROW(adaptive_cells(grid, flat, 1.5), std::domain_error);
  EXPECT_THROW(adaptive_cells({{0, 1}, {1, 0}}, flat, 1), std::domain_error);
  EXPECT_THROW(whole_cells({{0, 1}, {1, 0}}), std::domain_error);
  EXPECT_THROW(whole_cells(grid).index(1.5, 0), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
