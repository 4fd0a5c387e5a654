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
  OwnedStack stack{{1, 1, 1}, {}};
  Moments expected;
  for (int r = 0; r < 64; ++r) {
    stack.images.push_back({r == 0 ? 1e12F : 1 + 1e-3F * static_cast<float>(r)});
    expected.add(static_cast<double>(stack.images.back()[0]));
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
  ImageStack stack{{2, 1, 1}, {constant, constant, constant, other}};
  std::vector<double> mean(2);
  std::vector<double> m2(2);
  moments_of_range(stack, 0, {mean, m2});
  EXPECT_EQ(m2[0], 0);
  EXPECT_GT(m2[1], 0);
  EXPECT_EQ(mean[0], static_cast<double>(0.1F));
}

OwnedStack skewed_stack(std::uint32_t test_case) {
  Philox random(test_case);
  return draw_stack(extent, 19, [&](std::size_t e) {
    if (e == 5) return 2.5;
    return e % 7 == 0 && random.uniform() < 0.5 ? 0.0 : 100 + std::exp(random.normal());
  });
}

TEST(ElementMoments, AreThoseOfOneElementAfterTheOther) {
  const OwnedStack stack = skewed_stack(830);
  std::vector<Moments> all(extent.elements());
  element_moments(stack.view(), 0, all);
  for (std::size_t e = 0; e < all.size(); ++e) {
    const Moments expected = one_element(stack, e);
    ASSERT_EQ(all[e].count, expected.count);
    ASSERT_EQ(all[e].minimum, expected.minimum);
    ASSERT_EQ(all[e].maximum, expected.maximum);
    ASSERT_EQ(all[e].nonzero, expected.nonzero);
    ASSERT_NEAR(all[e].mean / expected.mean, 1, 1e-14);
    ASSERT_NEAR(all[e].m2, expected.m2, 1e-11 * expected.m2);
    ASSERT_NEAR(all[e].m3, expected.m3, 1e-10 * std::pow(expected.m2, 1.5));
    ASSERT_NEAR(all[e].m4, expected.m4, 1e-11 * expected.m4);
  }
}

TEST(ElementMoments, OfAConstantAreZeroExactly) {
  const OwnedStack stack = skewed_stack(831);
  std::vector<Moments> all(6);
  element_moments(stack.view(), 0, all);
  EXPECT_EQ(all[5].mean, 2.5);
  EXPECT_EQ(all[5].m2, 0);
  EXPECT_EQ(all[5].m4, 0);
}

TEST(ElementMoments, ARangeHasTheBitsOfTheWhole) {
  const OwnedStack stack = skewed_stack(832);
  std::vector<Moments> whole(extent.elements());
  std::vector<Moments> part(700);
  element_moments(stack.view(), 0, whole);
  element_moments(stack.view(), 1501, part);
  for (std::size_t i = 0; i < part.size(); ++i) ASSERT_EQ(part[i], whole[1501 + i]);
}

TEST(ElementMoments, WhatIsNotFiniteShowsInItsElementAlone) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    OwnedStack stack = skewed_stack(833);
    stack.images[7][40] = bad;
    std::vector<Moments> all(extent.elements());
    element_moments(stack.view(), 0, all);
    for (std::size_t e = 0; e < all.size(); ++e) ASSERT_EQ(std::isfinite(all[e].m2), e != 40);
  }
}

TEST(ImageSums, OfChannelsAreThoseOfTheirElements) {
  tests::Philox random(876);
  for (const std::size_t channels : {1U, 2U, 3U, 5U}) {
    const ImageExtent small{71, 4, channels};
    const OwnedStack stack = draw_stack(small, 3, [&](std::size_t) { return random.normal(); });
    const std::vector<double> sums = image_channel_sums(stack.view());
    ASSERT_EQ(sums.size(), 3 * channels);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      double expected = 0;
      for (std::size_t e = i % channels; e < small.elements(); e += channels) {
        expected += static_cast<double>(stack.images[i / channels][e]);
      }
      EXPECT_NEAR(sums[i], expected, 1e-12);
    }
  }
}

}  // namespace
}  // namespace assay::stats
