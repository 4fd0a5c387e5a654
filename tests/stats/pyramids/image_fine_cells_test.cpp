// Compares the cells of image_pyramid, tile by tile and from blocks, with sums over each rectangle
// by itself.
#include "stats/pyramids/image_cells.h"
#include "tests/prelude.h"
#include "tests/stats/image_samples.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

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

void for_each_element(const ImageExtent& extent, const Cell& cell, const auto& visit) {
  const Rectangle& window = cell.group.windows[cell.index];
  for (std::size_t y = window.y; y < window.y + window.height; ++y) {
    for (std::size_t x = window.x; x < window.x + window.width; ++x) {
      visit((y * extent.width + x) * extent.channels + cell.channel,
            sign_of(cell.group, cell.index, x, y));
    }
  }
}

// Loops over its rectangle give a cell's own weighted means.
CellNoise noise_of(const ImagePair& pair, const std::array<Half, halves>& half, const Cell& cell) {
  CellNoise noise;
  double reciprocal_degrees = 0;
  for (std::size_t h = 0; h < halves; ++h) {
    const auto& weight = half[1 - h].weight;
    double weights = 0, squares = 0;
    for_each_element(pair.a.extent, cell, [&](std::size_t e, double) {
      weights += weight[e];
      squares += weight[e] * weight[e];
    });
    noise.concentration += squares / (weights * weights) / 2;
    for (std::size_t s = 0; s < sides_of_pair; ++s) {
      const ImageStack& stack = s == 0 ? pair.a : *pair.b;
      Moments moments;
      for (std::size_t r = h; r < stack.images.size(); r += halves) {
        double sum = 0;
        for_each_element(stack.extent, cell, [&](std::size_t e, double sign) {
          sum += sign * weight[e] * static_cast<double>(stack.images[r][e]);
        });
        moments.add(sum / weights);
      }
      const double part = std::pow(moments.standard_error() / 2, 2);
      noise.effect += (s == 0 ? 0.5 : -0.5) * moments.mean;
      noise.variance[s] += part;
      reciprocal_degrees += part * part / static_cast<double>(moments.count - 1);
    }
  }
  noise.degrees = std::pow(noise.variance[0] + noise.variance[1], 2) / reciprocal_degrees;
  return noise;
}

// The group's cell that is farthest from zero by its own noise.
Candidate farthest(const ImagePair& pair, const std::array<Half, halves>& half,
                   const WindowGroup& group) {
  Candidate best;
  for (std::size_t i = 0; i < group.windows.size(); ++i) {
    for (std::size_t c = 0; c < pair.a.extent.channels; ++c) {
      Candidate candidate{.finding = {}, .noise = noise_of(pair, half, {group, i, c})};
      candidate.finding.window = group.windows[i];
      candidate.finding.channel = c;
      candidate.finding.z = t_to_z(own_value(candidate.noise));
      if (std::abs(candidate.finding.z) > std::abs(best.finding.z)) best = candidate;
    }
  }
  return best;
}

// All light is alike here, so that neighbours take nothing away, or nearly.
void expect_cells_of(const ImageExtent& extent, std::uint32_t test_case) {
  Philox random(test_case);
  const auto draw = [&](std::size_t) { return 3 + random.normal(); };
  const OwnedStack first = draw_stack(extent, 17, draw);
  const OwnedStack second = draw_stack(extent, 16, draw);
  const ImageStack a = first.view();
  const ImageStack b = second.view();
  const ImagePair pair{a, b};
  const RowRange rows{0, extent.height};
  const std::array<Half, halves> half = halves_of(pair, rows);
  const Groups groups = window_groups(extent);
  std::vector<double> z(extent.elements());
  FineFindings found = empty_findings(pair, z);
  offer_fine_cells({pair, half, groups}, rows, found);
  add_up_alternating(found.coarse);
  EXPECT_EQ(found.counts.tested, extent.elements());
  std::vector<double> windows(groups.size());
  std::vector<Candidate> best(groups.size());
  for (const std::vector<Candidates>& tile : found.tiles) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      windows[g] += tile[g].windows();
      for (const Candidate& each : tile[g].kept()) {
        if (std::abs(each.finding.z) > std::abs(best[g].finding.z)) best[g] = each;
      }
    }
  }
  // Without noise around it, a coarse cell keeps its own value.
  const NoisePyramid none(extent, {16, 16});
  std::vector<BestCell> coarse(groups.size());
  for (std::size_t c = 0; c < extent.channels; ++c) {
    offer_coarse_cells(found.coarse, groups, c, none, coarse);
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    SCOPED_TRACE(testing::Message() << extent.width << " x " << extent.height << ", group " << g);
    const Candidate expected = farthest(pair, half, groups[g]);
    const bool is_coarse = coarse[g].windows > 0;
    const double cells = static_cast<double>(groups[g].windows.size() * extent.channels);
    EXPECT_EQ(is_coarse ? coarse[g].windows : windows[g], cells);
    if (is_coarse) {
      EXPECT_LE(std::abs(coarse[g].finding->effect.t()),
                std::abs(own_value(expected.noise).t) + 1e-6);
      EXPECT_GE(std::abs(coarse[g].finding->effect.t()),
                0.7 * std::abs(own_value(expected.noise).t));
      continue;
    }
    EXPECT_EQ(best[g].finding.channel, expected.finding.channel);
    EXPECT_EQ(best[g].finding.window, expected.finding.window);
    EXPECT_NEAR(best[g].noise.effect, expected.noise.effect, 1e-9);
    for (const std::size_t s : {0U, 1U}) {
      EXPECT_NEAR(best[g].noise.variance[s], expected.noise.variance[s], 1e-9);
    }
    EXPECT_NEAR(best[g].noise.concentration, expected.noise.concentration, 1e-9);
    EXPECT_NEAR(best[g].noise.degrees, expected.noise.degrees, 1e-7);
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
  Candidate first;
  first.finding.window = {2, 0, 2, 2};
  first.finding.z = 2.5;
  first.noise = {.effect = 2.5, .variance = {1, 0}, .degrees = 30};
  Candidate later = first;
  later.finding.window = {0, 2, 2, 2};
  const NoisePyramid none({4, 4, 1}, {16, 16});
  for (const bool in_order : {true, false}) {
    BestCell best;
    offer(best, in_order ? first : later, none);
    offer(best, in_order ? later : first, none);
    ASSERT_TRUE(best.finding);
    EXPECT_EQ(best.finding->window, first.finding.window);
  }
}

}  // namespace
}  // namespace assay::stats
