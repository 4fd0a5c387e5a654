// How many lens samples follow a pilot, and which are averaged.

#include "depth_of_field/pixel.h"
#include "tests/prelude.h"

namespace assay::depth_of_field {
namespace {

// s^2 / 0.11^2 is 20.66 of s^2 = 1/4.
TEST(TwoStage, AsksForTheVarianceOverTheSquareOfTheNoiseRoundedUp) {
  const StageRule rule{.pilot = 4, .noise = .11, .most = 50};
  EXPECT_EQ(rule.count(.25), 21);
  EXPECT_EQ(rule.count(0), 1);
  EXPECT_EQ(rule.count(1e-9), 1);
  EXPECT_EQ(rule.count(3), 50);
}

// A pilot of 0, 1, 0, 1 has the variance 1/3, 27.5 squares of the noise; 4, 5, ..., 31 follow.
TEST(TwoStage, AveragesOnlyWhatFollowsThePilot) {
  const StageRule rule{.pilot = 4, .noise = .11, .most = 50};
  double drawn = 0;
  const auto draw = [&] {
    const double x = drawn < 4 ? (drawn == 1 || drawn == 3) : drawn;
    ++drawn;
    return x;
  };
  EXPECT_DOUBLE_EQ(FreshSamples{}(rule, draw), 17.5);
  EXPECT_EQ(drawn, 32);
}

}  // namespace
}  // namespace assay::depth_of_field
