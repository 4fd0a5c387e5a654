#include "stats/images/image_moments.h"

#include "tests/prelude.h"
#include "tests/stats/image_samples.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

constexpr ImageExtent extent = tests::uneven;

OwnedStack normal_stack(std::uint32_t test_case, std::size_t replicates) {
  Philox random(test_case);
  return draw_stack(extent, replicates, [&](std::size_t) { return 5 + random.normal(); });
}

TEST(ImageMoments, EveryElementHasTheMomentsOfItsOwnValues) {
  const OwnedStack stack = normal_stack(800, 18);
  std::vector<double> mean(extent.elements());
  std::vector<double> m2(extent.elements());
  moments_of_range(stack.view(), 0, {mean, m2});
  for (std::size_t e = 0; e < mean.size(); ++e) {
    const Moments expected = one_element(stack, e);
    ASSERT_NEAR(mean[e], expected.mean, 1e-14);
    ASSERT_NEAR(m2[e] / expected.m2, 1, 1e-12);
  }
}

TEST(ImageMoments, ARangeHasTheBitsOfTheWhole) {
  const OwnedStack stack = normal_stack(801, 16);
  std::vector<double> whole(extent.elements());
  std::vector<double> part(100);
  std::vector<double> m2(extent.elements());
  moments_of_range(stack.view(), 0, {whole, m2});
  moments_of_range(stack.view(), 1500, {part, std::span(m2).first(100)});
  for (std::size_t i = 0; i < part.size(); ++i) ASSERT_EQ(part[i], whole[1500 + i]);
}

TEST(ImageMoments, EveryOtherImageIsAHalf) {
  const OwnedStack stack = normal_stack(802, 17);
  std::vector<double> mean(extent.elements());
  std::vector<double> m2(extent.elements());
  moments_of_range(stack.view(), 0, {mean, m2}, {.start = 1, .step = 2});
  Moments odd;
  for (std::size_t r = 1; r < 17; r += 2) odd.add(static_cast<double>(stack.images[r][7]));
  EXPECT_NEAR(mean[7], odd.mean, 1e-14);
  EXPECT_NEAR(m2[7] / odd.m2, 1, 1e-12);
}

TEST(ImageMoments, ADistantFirstValueCostsNoAccuracy) {
  tests::StackOf<double> stack{{1, 1, 1}, {}};
  Moments expected;
  for (int r = 0; r < 64; ++r) {
    stack.images.push_back({r == 0 ? 1e12 : 1 + 1e-3 * r});
    expected.add(stack.images.back()[0]);
  }
  double mean = 0;
  double m2 = 0;
  moments_of_range(stack.view(), 0, {{&mean, 1}, {&m2, 1}});
  EXPECT_NEAR(mean / expected.mean, 1, 1e-14);
  EXPECT_NEAR(m2 / expected.m2, 1, 1e-13);
}

TEST(ImageMoments, OnlyConstantsHaveNoVariance) {
  const std::vector<float> constant{0.1F, 0.3F};
  const std::vector<float> other{0.1F, std::nextafter(0.3F, 1.0F)};
  ImageStack<float> stack{{2, 1, 1}, {constant, constant, constant, other}};
  std::vector<double> mean(2);
  std::vector<double> m2(2);
  moments_of_range(stack, 0, {mean, m2});
  EXPECT_EQ(m2[0], 0);
  EXPECT_GT(m2[1], 0);
  EXPECT_EQ(mean[0], static_cast<double>(0.1F));
}

}  // namespace
}  // namespace assay::stats
