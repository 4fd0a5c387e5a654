#include "stats/images/image_cell_moments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/basics/moments.h"
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

/// The moments of all windows in one channel, group by group, from rows after rows.
std::vector<std::vector<CellMoments>> moments_of_groups(const WeightedImages<double>& images,
                                                        const std::vector<WindowGroup>& groups,
                                                        std::size_t channel) {
  const ImageExtent& extent = images.stack.extent;
  RowCellMoments cells(extent, groups);
  std::vector<std::vector<CellMoments>> all(groups.size());
  const auto append = [&](std::size_t g, const std::vector<CellMoments>& from, std::size_t& done,
                          std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) all[g].push_back(from.at(done++));
  };
  for (std::size_t row = 0; row < extent.height; row += RowCellMoments::row_unit) {
    const RowRange rows{row, std::min(row + RowCellMoments::row_unit, extent.height)};
    const ChannelMoments found = cells.take(images, rows, tests::last_first);
    std::size_t done = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (!cells.is_larger(groups[g])) {
        append(g, found[channel], done, cells.cells_in(groups[g], rows));
      }
    }
    EXPECT_EQ(done, found[channel].size());
  }
  const ChannelMoments larger = cells.larger(tests::last_first);
  std::size_t done = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (cells.is_larger(groups[g])) append(g, larger[channel], done, groups[g].windows.size());
  }
  EXPECT_EQ(done, larger[channel].size());
  return all;
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
  const WeightedImages images{stack, weights, 0, 3, 1};
  const std::vector<WindowGroup> groups = aligned_groups(extent);
  EXPECT_EQ(images.taken(), (std::vector<std::size_t>{0, 2, 3, 5, 6, 8}));
  for (std::size_t c = 0; c < extent.channels; ++c) {
    const auto cells = moments_of_groups(images, groups, c);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      ASSERT_EQ(cells[g].size(), groups[g].windows.size());
      for (std::size_t w = 0; w < groups[g].windows.size(); ++w) {
        Moments expected;
        for (const std::size_t r : images.taken()) {
          expected.add(sum_over(images, r, groups[g].windows[w], c));
        }
        ASSERT_NEAR(cells[g][w].m2 / expected.m2, 1, 1e-11) << "size " << groups[g].size;
        ASSERT_NEAR(cells[g][w].m3, expected.m3, 1e-10 * std::pow(expected.m2, 1.5));
      }
    }
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
