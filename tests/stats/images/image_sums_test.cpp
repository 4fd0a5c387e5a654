#include "stats/images/image_sums.h"

#include "tests/prelude.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

// Twelve images: eight in step, and four. Sums of doubles are rounded at every step. These floats
// add up without rounding.
TEST(ImageSums, HaveTheBitsOfAddingUpEachImageAlone) {
  tests::Philox random(875);
  std::vector<std::vector<double>> images;
  for (int r = 0; r < 12; ++r) images.push_back(tests::normals(random, tests::uneven.elements()));
  const std::vector<double> sums =
      image_sums(ImageStack<double>{tests::uneven, {images.begin(), images.end()}});
  ASSERT_EQ(sums.size(), 12U);
  for (std::size_t r = 0; r < sums.size(); ++r) {
    double expected = 0;
    for (const double value : images[r]) expected += value;
    EXPECT_EQ(sums[r], expected);
  }
}

TEST(ImageSums, OfChannelsAreThoseOfTheirElements) {
  tests::Philox random(876);
  for (const std::size_t channels : {1U, 2U, 3U, 5U}) {
    const ImageExtent extent{7, 4, channels};
    std::vector<std::vector<double>> images;
    for (int r = 0; r < 3; ++r) images.push_back(tests::normals(random, extent.elements()));
    const std::vector<double> sums =
        image_channel_sums(ImageStack<double>{extent, {images.begin(), images.end()}});
    ASSERT_EQ(sums.size(), 3 * channels);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      double expected = 0;
      for (std::size_t e = i % channels; e < extent.elements(); e += channels) {
        expected += images[i / channels][e];
      }
      EXPECT_EQ(sums[i], expected);
    }
  }
}

}  // namespace
}  // namespace assay::stats
