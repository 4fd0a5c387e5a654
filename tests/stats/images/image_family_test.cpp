#include "stats/images/image_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "stats/pyramids/image_pyramid.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

using tests::draw_stack;

constexpr ImageExtent small{12, 10, 1};

TEST(ImageFamily, AnEnergyFromElsewhereCountsBelowItsNoticeAlone) {
  tests::Philox random(843);
  const auto normal = [&](std::size_t) { return random.normal(); };
  const tests::OwnedStack a = draw_stack(small, 16, normal);
  const ImageFamily without =
      image_pyramid(a.view(), draw_stack(small, 16, normal).view(), {.energy = false});
  const double notice = energy_notice(without);
  ImageFamily unnoticed = without;
  add_energy(unnoticed, small, notice + 1e-9);
  EXPECT_EQ(unnoticed.log_p, without.log_p);
  EXPECT_EQ(unnoticed.groups.size(), without.groups.size() + 1);
  ImageFamily noticed = without;
  add_energy(noticed, small, notice - 1e-9);
  EXPECT_NEAR(noticed.log_p, without.log_p - 1e-9, 1e-12);
  EXPECT_EQ(noticed.winner.statistic, ImageStatistic::energy);
}

TEST(ImageFamily, SmallCellsAndTheEnergyLeaveEachByItself) {
  tests::Philox random(844);
  const auto normal = [&](std::size_t) { return random.normal(); };
  const tests::OwnedStack a = draw_stack(small, 16, normal);
  const tests::OwnedStack b = draw_stack(small, 16, normal);
  const ImageFamily all = image_pyramid(a.view(), b.view());
  const auto left = [&](LeftOut which) {
    ImageFamily family = all;
    leave_out(family, which);
    std::array<bool, 2> found{};
    for (const ImageFinding& group : family.groups) {
      if (group.statistic == ImageStatistic::energy) found[0] = true;
      if (group.statistic == ImageStatistic::window && group.size == 1) found[1] = true;
    }
    return found;
  };
  EXPECT_EQ(left({}), (std::array{true, true}));
  EXPECT_EQ(left({.smallest = 2}), (std::array{true, false}));
  EXPECT_EQ(left({.energy = true}), (std::array{false, true}));
}

// An element is 1 below its reference in every replicate. Sums contain all of it. Left to sums, it
// is no certain difference by itself.
TEST(ImageFamily, ElementsThatAreLeftToSumsTakePartInThemAlone) {
  tests::Philox random(845);
  constexpr std::size_t dark = 17;
  const tests::OwnedStack a =
      draw_stack(small, 16, [&](std::size_t i) { return i == dark ? -1.0 : random.normal(); });
  const std::vector<double> zero(small.elements());
  const std::vector<double> weights(small.elements(), 1);
  const std::vector<std::size_t> left{dark};
  std::vector<double> z(small.elements());
  const auto whole_image_z = [&](const std::vector<double>& reference,
                                 std::span<const std::size_t> only_in_sums) {
    const ImageFamily family =
        image_pyramid(a.view(), ImageReference{small, reference, {}},
                      {.weights = weights, .only_in_sums = only_in_sums, .z = z});
    EXPECT_EQ(family.different_constants, 0u);
    EXPECT_EQ(family.equal_constants, 1u);
    EXPECT_EQ(family.tested, small.elements() - 1);
    const auto whole = std::ranges::find_if(family.groups, [](const ImageFinding& group) {
      return group.statistic == ImageStatistic::window && group.window.width == small.width;
    });
    return whole->z;
  };
  std::vector<double> equal_there = zero;
  equal_there[dark] = -1;
  const double with = whole_image_z(zero, left);
  EXPECT_EQ(z[dark], 0);
  const double without = whole_image_z(equal_there, {});
  // The sum of 119 normal means of 16 has the standard deviation 2.7.
  EXPECT_NEAR(without - with, 1 / std::sqrt(119 / 16.0), 0.15);
}

TEST(ImageFamily, APositiveLogarithmIsRefused) {
  ImageFamily family;
  EXPECT_THROW(add_energy(family, small, 0.1), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
