#include "stats/image_family.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stats/image_pyramid.h"
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

TEST(ImageFamily, APositiveLogarithmIsRefused) {
  ImageFamily family;
  EXPECT_THROW(add_energy(family, small, 0.1), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
