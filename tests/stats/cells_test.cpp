#include "stats/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace assay::stats {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Cells, IntervalIndicesCoverTheClosedInterval) {
  const IntervalGrid grid{-1, 1, 4};
  EXPECT_EQ(grid.index(-1), 0U);
  EXPECT_EQ(grid.index(-.5), 1U);
  EXPECT_EQ(grid.index(.49), 2U);
  EXPECT_EQ(grid.index(1), 3U);
  EXPECT_THROW(grid.index(1.01), std::domain_error);
  EXPECT_THROW(grid.index(std::nan("")), std::domain_error);
}

TEST(Cells, HemisphereIndicesWrapInAzimuth) {
  const HemisphereGrid grid{2, 4};
  EXPECT_EQ(grid.index({0, 0}), 0U);
  EXPECT_EQ(grid.index({1, 0}), 4U);
  EXPECT_EQ(grid.index({.2, -.1}), 3U);
  EXPECT_EQ(grid.index({.2, 2 * pi + .1}), 0U);
  EXPECT_LT(grid.index({1, -1e-18}), 8U);
  EXPECT_THROW(grid.index({-.1, 0}), std::domain_error);
}

TEST(Cells, ProbabilitiesOfASmoothDensityAreExact) {
  const IntervalGrid grid{0, 3, 10};
  const auto cells = cell_probabilities(grid, [](double x) { return std::exp(-x); });
  for (std::size_t i = 0; i < 10; ++i) {
    const double low = .3 * static_cast<double>(i);
    EXPECT_NEAR(cells.probability[i], std::exp(-low) - std::exp(-low - .3), 1e-14);
  }
  EXPECT_NEAR(cells.total, -std::expm1(-3), 1e-14);
  EXPECT_LT(cells.total_error, 1e-9);
}

TEST(Cells, AJumpAnywhereIsFoundWithinItsError) {
  for (int k = 1; k < 500; ++k) {
    const double place = std::fmod(.6180339887498949 * k, 1);
    const auto density = [&](double x) { return x < place ? 2.0 : .5; };
    const auto cells = cell_probabilities(IntervalGrid{0, 1, 64}, density);
    EXPECT_NEAR(cells.total, 2 * place + .5 * (1 - place), cells.total_error + 1e-14) << place;
    EXPECT_LT(cells.total_error, 1e-9);
  }
}

TEST(Cells, CosineHemisphereHasItsClosedForm) {
  const HemisphereGrid grid{4, 8};
  const auto cells = cell_probabilities(grid, [](Direction d) { return d.cos_theta / pi; });
  for (std::size_t row = 0; row < 4; ++row) {
    const double low = static_cast<double>(row) / 4;
    const double expected = ((low + .25) * (low + .25) - low * low) / 8;
    EXPECT_NEAR(cells.probability[row * 8 + 3], expected, 1e-13);
  }
  EXPECT_NEAR(cells.total, 1, 1e-12);
}

TEST(Cells, AnAzimuthalLobeIsIntegrated) {
  const HemisphereGrid grid{3, 5};
  const auto density = [](Direction d) {
    return (1 + .5 * std::cos(d.phi)) * 3 * d.cos_theta * d.cos_theta / (2 * pi);
  };
  const auto cells = cell_probabilities(grid, density);
  const double width = 2 * pi / 5;
  const double expected =
      (8 - 1) / 27.0 / (2 * pi) * (width + .5 * (std::sin(2 * width) - std::sin(width)));
  EXPECT_NEAR(cells.probability[5 + 1], expected, 1e-13);
}

TEST(Cells, BadDensitiesThrow) {
  EXPECT_THROW(cell_probabilities(IntervalGrid{}, [](double) { return -1.0; }), std::domain_error);
  EXPECT_THROW(cell_probabilities(HemisphereGrid{}, [](Direction) { return std::nan(""); }),
               std::domain_error);
  EXPECT_THROW(cell_probabilities(IntervalGrid{1, 0, 3}, [](double) { return 1.0; }),
               std::domain_error);
}

}  // namespace
}  // namespace assay::stats
