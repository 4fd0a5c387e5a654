// Scattered samples and the images that tents make of them.

#include "depth_of_field/reconstruction.h"
#include "tests/prelude.h"

namespace assay::depth_of_field {
namespace {

double sum(const std::vector<Share>& shares) {
  double out = 0;
  for (const Share& share : shares) out += share.weight;
  return out;
}

/// A picture's value at each pixel, from its values at the samples.
template <class Picture>
std::vector<double> splatted(const Splats& splats, const std::vector<ImageSample>& samples,
                             const Picture& picture) {
  std::vector<double> out;
  for (const auto& shares : splats) {
    out.push_back(0);
    for (const Share& s : shares)
      out.back() += s.weight * picture(samples[s.sample].x, samples[s.sample].y);
  }
  return out;
}

TEST(Splats, RegularSamplesFillEveryTile) {
  const Grid grid{20, 9, 1};
  for (const std::size_t spacing : {1u, 2u, 4u, 8u}) {
    const auto samples = regular_samples(grid, spacing);
    std::size_t expected = 0;
    for (std::size_t y = 0; y < 9; y += spacing) expected += (20 + spacing - 1) / spacing;
    EXPECT_EQ(samples.size(), expected);
    for (const ImageSample& s : samples) {
      EXPECT_EQ(s.x % spacing + s.y % spacing, 0u);
      EXPECT_LT(s.x, 20u);
      EXPECT_LT(s.y, 9u);
      EXPECT_EQ(s.spacing, spacing);
    }
  }
}

// Pixels are 0.25 wide: pi / bandwidth of 2, 1, 0.99 and 0.3 leaves 8, 4, 2 and 1 pixels.
TEST(Splats, ATileTakesTwoSamplesOfItsShortestPeriod) {
  const Grid grid{40, 8, 10};
  std::vector<double> bandwidth(grid.pixels());
  const double detail[] = {0, 2, 1, .99, .3};
  for (std::size_t tile = 1; tile < 5; ++tile) {
    // One pixel of a tile decides for all.
    bandwidth[5 * 40 + tile * 8 + 3] = std::numbers::pi / detail[tile];
  }
  const std::size_t spacing[] = {8, 8, 4, 2, 1};
  std::vector<std::size_t> count(5);
  for (const ImageSample& s : samples_by_bandwidth(grid, bandwidth)) {
    EXPECT_EQ(s.spacing, spacing[s.x / 8]) << s.x;
    ++count[s.x / 8];
  }
  EXPECT_EQ(count, (std::vector<std::size_t>{1, 1, 4, 16, 64}));
}

// Up to the last sample in each direction; beyond, a tent falls off.
TEST(Splats, TentsOfOneSpacingAreBilinearInterpolation) {
  const Grid grid{17, 9, 1};
  const auto picture = [](std::size_t x, std::size_t y) {
    return 3. + .5 * static_cast<double>(x) - .25 * static_cast<double>(y) +
           .125 * static_cast<double>(x * y);
  };
  for (const std::size_t spacing : {1u, 2u, 4u, 8u}) {
    const auto samples = regular_samples(grid, spacing);
    const Splats splats = tents(grid, samples);
    const auto image = splatted(splats, samples, picture);
    for (std::size_t i = 0; i < grid.pixels(); ++i) {
      EXPECT_NEAR(sum(splats[i]), 1, 1e-14);
      EXPECT_NEAR(image[i], picture(i % 17, i / 17), 1e-13) << spacing << ' ' << i;
    }
  }
}

// A tile of every pixel beside one of every eighth: their tents overlap.
TEST(Splats, NormalisedSharesKeepWhatIsConstant) {
  const Grid grid{24, 8, 1};
  std::vector<double> bandwidth(grid.pixels());
  bandwidth[10] = 1e6;
  const auto samples = samples_by_bandwidth(grid, bandwidth);
  const Splats raw = tents(grid, samples);
  const Splats all = normalised(raw);
  double most = 0;
  for (std::size_t i = 0; i < grid.pixels(); ++i) {
    most = std::max(most, sum(raw[i]));
    EXPECT_NEAR(sum(all[i]), 1, 1e-14) << i;
    ASSERT_EQ(all[i].size(), raw[i].size());
    for (std::size_t k = 0; k < raw[i].size(); ++k) {
      EXPECT_DOUBLE_EQ(all[i][k].weight * sum(raw[i]), raw[i][k].weight);
    }
  }
  EXPECT_GT(most, 1.5);
}

}  // namespace
}  // namespace assay::depth_of_field
