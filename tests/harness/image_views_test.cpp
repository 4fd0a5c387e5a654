// Images as views of whole observations.

#include "harness/image_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace assay::harness {
namespace {

using ::testing::ElementsAre;

const std::vector<std::vector<double>> observations{{1, 2, 3, 4}, {5, 6, 7, 8}};

TEST(ImageViews, OfElementsSideBySideCopyNothing) {
  const std::vector<std::size_t> channels{1, 2, 3};
  const ImageViews views(observations, channels);
  ASSERT_EQ(views.images().size(), 2U);
  EXPECT_EQ(views.images()[0].data(), observations[0].data() + 1);
  EXPECT_THAT(views.images()[1], ElementsAre(6, 7, 8));
}

TEST(ImageViews, OfOtherElementsAreInTheOrderOfTheChannels) {
  const std::vector<std::size_t> channels{2, 0};
  const ImageViews views(observations, channels);
  EXPECT_THAT(views.images()[0], ElementsAre(3, 1));
  EXPECT_THAT(views.images()[1], ElementsAre(7, 5));
}

TEST(ImageViews, StayWhereTheyAreWhenMoved) {
  ImageViews views(observations);
  const double* const first = views.images()[0].data();
  const ImageViews moved = std::move(views);
  EXPECT_EQ(moved.images()[0].data(), first);
  EXPECT_THAT(moved.images()[1], ElementsAre(5, 6, 7, 8));
}

}  // namespace
}  // namespace assay::harness
