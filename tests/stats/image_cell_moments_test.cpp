#include "stats/image_cell_moments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/moments.h"
#include "tests/stats/last_first.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::Philox;

std::vector<WindowGroup> aligned_groups(const ImageExtent& extent) {
  std::vector<WindowGroup> groups = window_groups(extent, 1);
  std::erase_if(groups, [](const WindowGroup& group) { return group.grid != Grid::aligned; });
  return groups;
}

double sum_over(const WeightedImages<double>& images, std::size_t image, const Rectangle& window,
                std::size_t channel) {
  const ImageExtent& extent = images.stack.extent;
  double sum = 0;
  for (std::size_t y = window.y; y < window.y + window.height; ++y) {
    for (std::size_t x = window.x; x < window.x + window.width; ++x) {
      const std::size_t e = (y * extent.width + x) * extent.channels + channel;
      sum += images.weights[e] * (images.stack.images[image][e] - images.stack.images[0][e]);
    }
  }
  return sum;
}

void expect_cells_of(const ImageExtent& extent, std::uint32_t test_case) {
  Philox random(test_case);
  std::vector<std::vector<double>> values(9, std::vector<double>(extent.elements()));
  for (auto& image : values) {
    for (double& value : image) value = std::exp(random.normal());
  }
  std::vector<double> weights(extent.elements());
  for (double& weight : weights) weight = 1 + random.uniform();
  const ImageStack<double> stack{extent, {values.begin(), values.end()}};
  const WeightedImages images{stack, weights, 3, 1};
  const std::vector<WindowGroup> groups = aligned_groups(extent);
  EXPECT_EQ(images.taken(), (std::vector<std::size_t>{0, 2, 3, 5, 6, 8}));
  const auto all = cell_moments(images, groups, tests::last_first);
  ASSERT_EQ(all.size(), extent.channels);
  for (std::size_t c = 0; c < extent.channels; ++c) {
    const std::vector<CellMoments>& cells = all[c];
    std::size_t cell = 0;
    for (const WindowGroup& group : groups) {
      for (const Rectangle& window : group.windows) {
        Moments expected;
        for (std::size_t r = 0; r < values.size(); ++r) {
          if (r % 3 != 1) expected.add(sum_over(images, r, window, c));
        }
        ASSERT_NEAR(cells[cell].m2 / expected.m2, 1, 1e-11) << "size " << group.size;
        ASSERT_NEAR(cells[cell].m3, expected.m3, 1e-10 * std::pow(expected.m2, 1.5));
        ++cell;
      }
    }
    EXPECT_EQ(cell, cells.size());
  }
}

TEST(CellMoments, AreThoseOfTheSumsOverTheirRectangles) {
  expect_cells_of({.width = 150, .height = 70, .channels = 2}, 870);  // several tiles, cut cells
  expect_cells_of({.width = 48, .height = 5, .channels = 3}, 871);
  expect_cells_of({.width = 128, .height = 64, .channels = 1}, 872);
  expect_cells_of({.width = 1, .height = 3, .channels = 1}, 873);
}

}  // namespace
}  // namespace assay::stats
