#include "stats/image_sums.h"

#include <gtest/gtest.h>

#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

// Twelve images: eight in step, and four.
TEST(ImageSums, HaveTheBitsOfAddingUpEachImageAlone) {
  tests::Philox random(875);
  const tests::OwnedStack stack =
      tests::draw_stack(tests::uneven, 12, [&](std::size_t) { return 1 + random.normal(); });
  const std::vector<double> sums = image_sums(stack.view());
  ASSERT_EQ(sums.size(), 12U);
  for (std::size_t r = 0; r < sums.size(); ++r) {
    double expected = 0;
    for (const float value : stack.images[r]) expected += static_cast<double>(value);
    EXPECT_EQ(sums[r], expected);
  }
}

}  // namespace
}  // namespace assay::stats
