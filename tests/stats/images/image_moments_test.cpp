#include "stats/images/image_moments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "stats/images/image_welch.h"
#include "tests/stats/image_samples.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::draw_stack;
using tests::one_element;
using tests::OwnedStack;
using tests::Philox;

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
  std::vector<std::vector<double>> images;
  Moments expected;
  for (int r = 0; r < 64; ++r) {
    images.push_back({r == 0 ? 1e12 : 1 + 1e-3 * r});
    expected.add(images.back()[0]);
  }
  ImageStack<double> stack{{1, 1, 1}, {}};
  for (const auto& image : images) stack.images.emplace_back(image);
  double mean = 0;
  double m2 = 0;
  moments_of_range(stack, 0, {{&mean, 1}, {&m2, 1}});
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

TEST(ImageWelch, PartsOfTheMapHaveTheBitsOfTheWhole) {
  const OwnedStack a = normal_stack(806, 16);
  const OwnedStack b = normal_stack(807, 16);
  std::vector<double> whole(extent.elements());
  std::vector<double> parts(extent.elements());
  welch_z(a.view(), b.view(), 0, whole);
  for (std::size_t first = 0; first < parts.size(); first += 1000) {
    const std::size_t size = std::min<std::size_t>(1000, parts.size() - first);
    welch_z(a.view(), b.view(), first, std::span(parts).subspan(first, size));
  }
  EXPECT_EQ(whole, parts);
}

// Two elements in 16 replicates: the first constant, the second not.
ImageStack<double> partly_constant(std::vector<std::vector<double>>& images, double constant) {
  for (int r = 0; r < 16; ++r) images.push_back({constant, std::cos(r)});
  ImageStack<double> stack{{2, 1, 1}, {}};
  for (const auto& image : images) stack.images.emplace_back(image);
  return stack;
}

TEST(ImageWelch, EqualConstantsDoNotCountAndDifferentOnesAreCertain) {
  std::vector<std::vector<double>> one;
  std::vector<std::vector<double>> same;
  std::vector<std::vector<double>> above;
  const auto a = partly_constant(one, 0.25);
  std::vector<double> z(2);
  WelchCounts counts = welch_z(a, partly_constant(same, 0.25), 0, z);
  EXPECT_EQ(counts.tested, 1);
  EXPECT_EQ(counts.equal_constants, 1);
  EXPECT_EQ(z[0], 0);
  counts = welch_z(a, partly_constant(above, std::nextafter(0.25, 1)), 0, z);
  EXPECT_EQ(counts.different_constants, 1);
  EXPECT_EQ(z[0], -std::numeric_limits<double>::infinity());
}

TEST(ImageWelch, AConstantAgainstAnUncertainReferenceIsNormal) {
  std::vector<std::vector<double>> images;
  const auto a = partly_constant(images, 0.25);
  const std::vector<double> value{0.05, 0};
  const std::vector<double> error{0.1, 0};
  const ImageReference reference{a.extent, value, error};
  std::vector<double> z(2);
  welch_z(a, reference, 0, z);
  EXPECT_NEAR(z[0], 2, 1e-12);
  EXPECT_NEAR(welch_element(a, reference, 0).statistic, 2, 1e-12);
}

TEST(ImageWelch, FewReplicatesAndBadValuesAreRefusedWithTheReason) {
  const OwnedStack a = normal_stack(808, 16);
  OwnedStack few = normal_stack(809, 15);
  std::vector<double> z(extent.elements());
  try {
    welch_z(a.view(), few.view(), 0, z);
    FAIL();
  } catch (const std::domain_error& error) {
    EXPECT_NE(std::string(error.what()).find("replicates = 15, must be at least 16"),
              std::string::npos);
    EXPECT_NE(std::string(error.what()).find("degrees of freedom"), std::string::npos);
  }
  OwnedStack bad = normal_stack(809, 16);
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    bad.images[3][1234] = value;
    try {
      welch_z(a.view(), bad.view(), 0, z);
      FAIL();
    } catch (const std::domain_error& error) {
      EXPECT_NE(std::string(error.what()).find("element 1234"), std::string::npos);
    }
  }
  EXPECT_THROW(welch_z(a.view(), a.view(), 1, z), std::domain_error);
  OwnedStack turned = normal_stack(809, 16);
  turned.extent = {31, 37, 3};
  EXPECT_THROW(welch_z(a.view(), turned.view(), 0, z), std::domain_error);
  const std::vector<double> value(extent.elements());
  const std::vector<double> negative(extent.elements(), -1);
  EXPECT_THROW(welch_z(a.view(), ImageReference{extent, value, negative}, 0, z), std::domain_error);
  EXPECT_THROW(welch_element(a.view(), a.view(), extent.elements()), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
