#include "stats/image_sums.h"

#include <gtest/gtest.h>

#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

// Twelve images: eight in step, and four. Doubles, of which sums are rounded at every step; so many
// floats add up without rounding.
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

}  // namespace
}  // namespace assay::stats
