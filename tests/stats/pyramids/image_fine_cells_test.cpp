// Compares the cells of image_pyramid, tile by tile and from blocks, with sums over each rectangle
// by itself.
#include "stats/pyramids/image_fine_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "stats/basics/moments.h"
#include "stats/images/image_family.h"
#include "stats/pyramids/image_coarse_cells.h"
#include "tests/stats/image_samples.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::draw_stack;
using tests::OwnedStack;
using tests::Philox;

using Groups = std::vector<WindowGroup>;

double sign_of(const WindowGroup& group, std::size_t index, std::size_t x, std::size_t y) {
  if (group.grid != Grid::alternating) return 1;
  const std::size_t odd = index == 0 ? x : index == 1 ? y : x + y;
  return odd % 2 == 0 ? 1 : -1;
}

struct Cell {
  const WindowGroup& group;
  std::size_t index;
  std::size_t channel;
};

// Mean and squared error of one cell's weighted sum over one half of a stack.
Moments cell_moments(const ImageStack<float>& stack, std::size_t half,
                     const std::vector<double>& weight, const Cell& cell) {
  const Rectangle& window = cell.group.windows[cell.index];
  Moments moments;
  for (std::size_t r = half; r < stack.images.size(); r += halves) {
    double sum = 0;
    for (std::size_t y = window.y; y < window.y + window.height; ++y) {
      for (std::size_t x = window.x; x < window.x + window.width; ++x) {
        const std::size_t e = (y * stack.extent.width + x) * stack.extent.channels + cell.channel;
        sum += sign_of(cell.group, cell.index, x, y) * weight[e] *
               static_cast<double>(stack.images[r][e]);
      }
    }
    moments.add(sum);
  }
  return moments;
}

StudentValue value_of(const ImagePair<float>& pair, const std::array<Half, halves>& half,
                      const Cell& cell) {
  double effect = 0;
  double variance = 0;
  double reciprocal_degrees = 0;
  for (std::size_t h = 0; h < halves; ++h) {
    for (const ImageStack<float>* stack : {&pair.a, pair.b}) {
      const Moments moments = cell_moments(*stack, h, half[1 - h].weight, cell);
      const double part = std::pow(moments.standard_error() / 2, 2);
      effect += (stack == pair.b ? -0.5 : 0.5) * moments.mean;
      variance += part;
      reciprocal_degrees += part * part / static_cast<double>(moments.count - 1);
    }
  }
  return {effect / std::sqrt(variance), variance * variance / reciprocal_degrees};
}

std::vector<BestCell> one_by_one(const ImagePair<float>& pair, const std::array<Half, halves>& half,
                                 const Groups& groups) {
  std::vector<BestCell> best(groups.size());
  for (std::size_t g = 1; g < groups.size(); ++g) {
    for (std::size_t i = 0; i < groups[g].windows.size(); ++i) {
      for (std::size_t c = 0; c < pair.a.extent.channels; ++c) {
        ImageFinding finding;
        finding.window = groups[g].windows[i];
        finding.channel = c;
        offer(best[g], finding, value_of(pair, half, {groups[g], i, c}));
      }
    }
  }
  return best;
}

void expect_cells_of(const ImageExtent& extent, std::uint32_t test_case) {
  Philox random(test_case);
  const auto draw = [&](std::size_t) { return 3 + random.normal(); };
  const OwnedStack first = draw_stack(extent, 17, draw);
  const OwnedStack second = draw_stack(extent, 16, draw);
  const ImageStack<float> a = first.view();
  const ImageStack<float> b = second.view();
  const ImagePair<float> pair{a, &b, nullptr};
  const RowRange rows{0, extent.height};
  const std::array<Half, halves> half = halves_of(pair, rows);
  const Groups groups = window_groups(extent, 1);
  FineFindings found{empty_blocks(pair), std::vector<BestCell>(groups.size())};
  offer_fine_cells<float>({pair, half, groups}, rows, found);
  add_up_alternating(found.coarse);
  std::vector<BestCell>& best = found.best;
  for (std::size_t c = 0; c < extent.channels; ++c) {
    offer_coarse_cells(found.coarse, groups, c, best);
  }
  const std::vector<BestCell> expected = one_by_one(pair, half, groups);
  for (std::size_t g = 1; g < groups.size(); ++g) {
    SCOPED_TRACE(testing::Message() << extent.width << " x " << extent.height << ", group " << g);
    ASSERT_EQ(best[g].windows, expected[g].windows);
    EXPECT_EQ(best[g].finding.channel, expected[g].finding.channel);
    EXPECT_EQ(best[g].finding.window, expected[g].finding.window);
    EXPECT_NEAR(best[g].value.t, expected[g].value.t, 1e-9);
    EXPECT_NEAR(best[g].value.degrees, expected[g].value.degrees, 1e-8);
  }
}

TEST(FineCells, AreTheSumsOverTheirRectangles) {
  expect_cells_of({.width = 32, .height = 32, .channels = 1}, 860);
  expect_cells_of({.width = 145, .height = 19, .channels = 3}, 861);  // several tiles, cut cells
  expect_cells_of({.width = 21, .height = 37, .channels = 2}, 862);
}

TEST(FineCells, OfSmallImagesAreCutOffAtEveryEdge) {
  expect_cells_of({.width = 3, .height = 2, .channels = 1}, 863);
  expect_cells_of({.width = 5, .height = 1, .channels = 2}, 864);
  expect_cells_of({.width = 1, .height = 8, .channels = 1}, 865);
  expect_cells_of({.width = 6, .height = 16, .channels = 3}, 866);
  expect_cells_of({.width = 2, .height = 2, .channels = 1}, 867);
}

TEST(BestCell, IsTheFirstOfEqualsInWhicheverOrderTheyCome) {
  ImageFinding first;
  first.window = {2, 0, 2, 2};
  ImageFinding later;
  later.window = {0, 2, 2, 2};
  for (const bool in_order : {true, false}) {
    BestCell best;
    offer(best, in_order ? first : later, {2.5, 30});
    offer(best, in_order ? later : first, {-2.5, 30});
    EXPECT_EQ(best.finding.window, first.window);
    EXPECT_EQ(best.windows, 2);
  }
}

}  // namespace
}  // namespace assay::stats
