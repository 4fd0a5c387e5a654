// Images as views of whole observations.

#include "harness/sampling/image_views.h"

#include "tests/prelude.h"

namespace assay::harness {
namespace {

const std::vector<std::vector<double>> observations{{1, 2, 3, 4}, {5, 6, 7, 8}};
const std::vector<float> one{1, 2, 3};
const std::vector<float> two{4, 5, 6};
const std::vector<std::span<const float>> pictures{one, two};

TEST(ImageViews, OfElementsSideBySideCopyNothing) {
  const std::vector<std::size_t> channels{1, 2, 3};
  const ImageViews views(Observations(observations), channels);
  ASSERT_EQ(views.images<double>().size(), 2U);
  EXPECT_EQ(views.images<double>()[0].data(), observations[0].data() + 1);
  EXPECT_THAT(views.images<double>()[1], ElementsAre(6, 7, 8));
}

TEST(ImageViews, OfOtherElementsAreInTheOrderOfTheChannels) {
  const std::vector<std::size_t> channels{2, 0};
  const ImageViews views(Observations(observations), channels);
  EXPECT_THAT(views.images<double>()[0], ElementsAre(3, 1));
  EXPECT_THAT(views.images<double>()[1], ElementsAre(7, 5));
}

TEST(ImageViews, StayWhereTheyAreWhenMoved) {
  ImageViews views(observations);
  const double* const first = views.images<double>()[0].data();
  const ImageViews moved = std::move(views);
  EXPECT_EQ(moved.images<double>()[0].data(), first);
  EXPECT_THAT(moved.images<double>()[1], ElementsAre(5, 6, 7, 8));
}

TEST(ImageViews, OfPicturesHaveTheirPrecision) {
  const std::vector<std::size_t> whole{0, 1, 2};
  const ImageViews views{Observations(pictures), whole};
  ASSERT_TRUE(views.single_precision());
  EXPECT_EQ(views.images<float>()[1].data(), two.data());
  const std::vector<std::size_t> some{2, 0};
  EXPECT_THAT(ImageViews(Observations(pictures), some).images<float>()[1], ElementsAre(6, 4));
  const ImageViews wide = widened(views.images<float>());
  EXPECT_FALSE(wide.single_precision());
  EXPECT_THAT(wide.images<double>()[0], ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace assay::harness
