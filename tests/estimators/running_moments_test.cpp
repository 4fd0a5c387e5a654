// Welford's moments against sums worked out by hand.

#include "depth_of_field/pixel.h"
#include "tests/prelude.h"

namespace assay::depth_of_field {
namespace {

RunningMoments of(double shift) {
  RunningMoments all;
  for (const double x : {2., 4., 4., 4., 5., 5., 7., 9.}) all.add(shift + x);
  return all;
}

// Mean 5, squares of distances 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32.
TEST(RunningMoments, AreThoseOfTheSample) {
  EXPECT_EQ(of(0).count(), 8);
  EXPECT_DOUBLE_EQ(of(0).mean(), 5);
  EXPECT_DOUBLE_EQ(of(0).variance(), 32. / 7);
}

// Raw sums of squares would leave nothing but rounding: squares of 1e9 have a last place of 128.
TEST(RunningMoments, KeepTheVarianceFarFromZero) {
  EXPECT_DOUBLE_EQ(of(1e9).mean(), 1e9 + 5);
  EXPECT_NEAR(of(1e9).variance(), 32. / 7, 1e-6);
  EXPECT_NEAR(of(-1e9).variance(), 32. / 7, 1e-6);
}

TEST(RunningMoments, OfEqualNumbersHaveNoVariance) {
  RunningMoments all;
  for (int i = 0; i < 1000; ++i) all.add(0.1);
  EXPECT_EQ(all.variance(), 0);
  EXPECT_EQ(all.mean(), 0.1);
}

TEST(RunningMoments, OfOneNumberHaveNoVarianceToSpeakOf) {
  RunningMoments one;
  one.add(3);
  EXPECT_EQ(one.mean(), 3);
  EXPECT_TRUE(std::isnan(one.variance()));
}

}  // namespace
}  // namespace assay::depth_of_field
