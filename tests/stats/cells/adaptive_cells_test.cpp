
#include "stats/cells/chi_square.h"
#include "tests/stats/point_by_point.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

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

void expect_masses(const AdaptiveCells& found, const std::function<double(PlaneCell)>& mass,
                   double tolerance, double most) {
  for (std::size_t i = 0; i < found.cells.size(); ++i) {
    EXPECT_NEAR(found.mass.probability[i], mass(found.cells.cells[i]), tolerance);
    EXPECT_LE(found.mass.probability[i], most);
  }
}

// The law 4 x y gives a cell the product of the differences of squares.
TEST(AdaptiveCells, EveryCellHasItsMassAndNoMoreThanItsShare) {
  const auto found = adaptive_cells(
      unit_grid(4, 4), on_unit_square([](double x, double y) { return 4 * x * y; }), 1.0 / 64);
  const auto below = [](const Span& s) { return s.high * s.high - s.low * s.low; };
  const auto mass = [&](const PlaneCell& cell) { return below(cell.x) * below(cell.y); };
  expect_masses(found, mass, 1e-12, 1.0 / 64);
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
  EXPECT_EQ(found.cells.nodes.size(), 15U);
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

TEST(AdaptiveCells, ANarrowPeakIsCountedInManyCells) {
  const auto found = adaptive_cells(unit_grid(16, 32), on_unit_square(narrow, {100}), 1.0 / 256);
  const auto mass = [](const PlaneCell& cell) {
    return normal_mass(cell.x, narrow.x, narrow.deviation) *
           normal_mass(cell.y, narrow.y, narrow.deviation);
  };
  expect_masses(found, mass, 1e-7, 1.0 / 256);
  const auto holds = [](double probability) { return probability > 1.0 / 2048; };
  EXPECT_GT(std::ranges::count_if(found.mass.probability, holds), 256);
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
    return adaptive_cells(unit_grid(16, 32), on_unit_square(narrow, {100}), share);
  };
  const AdaptiveCells fine = cells(1.0 / 256);
  const AdaptiveCells coarse = cells(1);
  const auto fit = [&](const AdaptiveCells& found, double wider) {
    return [&found, wider](Philox& random) {
      const CellCounts counts = counts_of(random, found, wider * narrow.deviation);
      return chi_square_fit(counts, {.probability_tolerance = 1e-6}).test.log_p_upper;
    };
  };
  expect_calibrated({381, tests::repetitions(3000)}, fit(fine, 1));
  expect_caught({382, 1000}, fit(fine, 1.2));
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
  const auto found = adaptive_cells(even_borders(4), {.values = at}, 1.0 / 64, {.tolerance = 1e-3});
  for (const PlaneCell& cell : found.cells.cells) EXPECT_LT(cell.x.low, cell.x.high);
  const auto tiny = adaptive_cells({1e9, std::nextafter(1e9, 2e9)}, {.values = at}, 1.0 / 64,
                                   {.tolerance = 1e-3});
  EXPECT_EQ(tiny.cells.size(), 1U) << "nothing lies between two neighbours";
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

// One value in a hundred belongs to a peak, so that no quantile of all need lie in it.
TEST(AdaptiveCells, APeakOfFewDrawsStandsOutAmongThoseOfItsDensity) {
  const auto normal = [](double x) {
    const double z = (x - .613) / 1e-4;
    return std::exp(-z * z / 2) / (1e-4 * std::sqrt(2 * std::numbers::pi));
  };
  PlaneDensity density =
      on_unit_square([&](double x, double y) { return .99 + .01 * normal(x) * normal(y); });
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u}) {
    Philox random(32, seed);
    std::vector<std::array<double, 2>> drawn;
    for (int i = 0; i < 4096; ++i) {
      const bool in_peak = random.uniform() < .01;
      const auto draw = [&] { return in_peak ? .613 + 1e-4 * random.normal() : random.uniform(); };
      drawn.push_back({draw(), draw()});
    }
    const auto borders = [&](std::size_t k) {
      std::vector<double> places;
      for (const auto& at : drawn) places.push_back(at[k]);
      return borders_of_peaks(places, density.x);
    };
    density.drawn = drawn;
    std::ranges::stable_sort(drawn, std::greater(),
                             [&](const auto& at) { return normal(at[0]) * normal(at[1]); });
    density.x_panels.borders = borders(0);
    density.y_panels.borders = borders(1);
    const auto found = adaptive_cells(unit_grid(16, 32), density, 1.0 / 40, {.tolerance = 1e-8});
    EXPECT_NEAR(found.mass.total, 1, 1e-6) << seed;
  }
}

// Strata of 900 values have too few.
TEST(AdaptiveCells, APeakOfHalfOfAFewHundredDrawsHasBorders) {
  Philox random(33);
  std::vector<double> values;
  for (int i = 0; i < 450; ++i) values.push_back(.613 + 1e-5 * random.normal());
  for (int i = 0; i < 450; ++i) values.push_back(random.uniform());
  const std::vector<double> borders = borders_of_peaks(values, {0, 1});
  EXPECT_GE(std::ranges::count_if(borders, [](double x) { return std::abs(x - .613) < 3e-5; }), 10);
}

TEST(AdaptiveCells, WithoutEvaluationsACellStaysWhole) {
  std::uint64_t evaluations = 0;
  const auto counted = [&](double x, double y) {
    ++evaluations;
    return narrow(x, y);
  };
  const PlaneDensity density = on_unit_square(counted, {100});
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
  const auto found = adaptive_cells(even_borders(64), density, 1.0 / 32);
  const auto mass = [](const PlaneCell& part) {
    return std::exp(-50 * part.x.low) - std::exp(-50 * part.x.high);
  };
  expect_masses(found, mass, 1e-12, 1.0 / 32);
  EXPECT_GT(found.cells.size(), 64U + 30);
  expect_a_partition(found.cells);
}

}  // namespace
}  // namespace assay::stats
