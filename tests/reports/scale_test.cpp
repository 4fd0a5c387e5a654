#include "reports/viewer/scale.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

std::vector<std::string> labels(const Scale& scale, int wanted) {
  std::vector<std::string> result;
  for (const Tick& tick : scale.ticks(wanted)) result.push_back(tick.label);
  return result;
}

TEST(Scale, TicksAreRoundNumbers) {
  EXPECT_EQ(labels(Scale({{0, 1}, {0, 100}}), 5),
            (std::vector<std::string>{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(Scale({{-0.003, 0.003}, {0, 100}}), 3),
            (std::vector<std::string>{"-0.002", "0", "0.002"}));
  EXPECT_EQ(labels(Scale({{0, 5e6}, {0, 100}}), 3), (std::vector<std::string>{"0", "2e6", "4e6"}));
  EXPECT_EQ(labels(Scale({{0.002, 40}, {0, 100}, Scale::Kind::logarithmic}), 5),
            (std::vector<std::string>{"0.01", "0.1", "1", "10"}));
}

TEST(Scale, MapsItsDomainAndClampsTheRest) {
  const Scale linear({{0, 10}, {100, 200}});
  EXPECT_DOUBLE_EQ(linear(5), 150);
  EXPECT_DOUBLE_EQ(linear(-1), 100);
  EXPECT_DOUBLE_EQ(linear(1e300), 200);
  const Scale logarithmic({{1, 100}, {0, 100}, Scale::Kind::logarithmic});
  EXPECT_DOUBLE_EQ(logarithmic(10), 50);
  EXPECT_DOUBLE_EQ(logarithmic(0), 0);
}

RC_GTEST_PROP(Scale, AnyNumbersGiveAFiniteAxisWithAFewTicks, ()) {
  Extent extent;
  for (int i = 0; i < 3; ++i) extent.include(*any_double());
  if (extent.empty()) extent.include(0.0);
  const Scale scale({extent.padded(0.05), {0, 100}});
  const auto ticks = scale.ticks(5);
  RC_ASSERT(ticks.size() <= 11u);
  for (const Tick& tick : ticks) {
    const double position = scale(tick.value);
    RC_ASSERT(position >= 0 && position <= 100);
    RC_ASSERT(tick.label.size() <= 16u);
  }
}

}  // namespace
}  // namespace assay::reports
