#include "stats/images/image_moments.h"
#include "tests/prelude.h"

namespace assay::stats {
namespace {

// Two images of two pixels and two channels.
const std::vector<double> dark{1, 10, 3, 30};
const std::vector<float> first_of_two{1, 10, 3, 30};
const std::vector<float> second_of_two{2, 14, 4, 42};
const ImageExtent extent{2, 1, 2};

TEST(ImageMeans, OfReplicatesEachChannelHasTheSpreadOfItsOwnMeans) {
  const ChannelMeans means = channel_means(ImageStack{extent, {first_of_two, second_of_two}});
  ASSERT_EQ(means.size(), 2U);
  EXPECT_DOUBLE_EQ(means[0].value, 2.5);  // of 2 and 3
  EXPECT_DOUBLE_EQ(means[0].standard_error, 0.5);
  EXPECT_DOUBLE_EQ(means[1].value, 24);  // of 20 and 28
  EXPECT_DOUBLE_EQ(means[1].standard_error, 4);
}

TEST(ImageMeans, OfAReferenceErrorsAreIndependentBetweenPixels) {
  const std::vector<double> error{3, 0, 4, 0.5};
  const ChannelMeans means =
      channel_means({.extent = extent, .value = dark, .standard_error = error});
  EXPECT_DOUBLE_EQ(means[0].value, 2);
  EXPECT_DOUBLE_EQ(means[0].standard_error, 2.5);  // sqrt(3^2 + 4^2) / 2
  EXPECT_DOUBLE_EQ(means[1].standard_error, 0.25);
  EXPECT_EQ(channel_means({.extent = extent, .value = dark})[0].standard_error, 0);
}

TEST(ImageMeans, TheBestChannelThatVariesTells) {
  const std::vector<double> errors =
      uniform_errors({{1, 0.3}, {10, 0.4}, {1, 0}}, {{1, 0.4}, {10, 0.3}, {1, 0}});
  EXPECT_THAT(errors, testing::ElementsAre(0.5, 0.5, 0));
  EXPECT_DOUBLE_EQ(least_error(errors, {{1, 0}, {10, 0}, {1, 0}}, false), 0.5);
  EXPECT_DOUBLE_EQ(least_error(errors, {{1, 0}, {10, 0}, {1, 0}}, true), 0.05);
  EXPECT_DOUBLE_EQ(least_error(errors, {{0, 0}, {10, 0}, {1, 0}}, true), 0.05);
}

}  // namespace
}  // namespace assay::stats
