#include "stats/images/image_element_moments.h"

#include "tests/prelude.h"
#include "tests/stats/image_samples.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

constexpr ImageExtent extent = tests::uneven;

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

}  // namespace
}  // namespace assay::stats
