#include "stats/means/theta_of_means.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(StudentT, AReferenceErrorEntersVarianceAndDegreesOfFreedom) {
  const Moments x = moments_of(golden_x);
  const double own = x.variance() / 10;
  const TestResult result = student_t(x, {1, std::sqrt(own)});
  EXPECT_NEAR(result.statistic, -.7040427405942026 / std::sqrt(2), 1e-14);
  EXPECT_NEAR(result.distribution.parameters.at(0), 36, 1e-12);
}

TEST(StudentT, TheIntervalEndsAreJustRejected) {
  const Moments x = moments_of(golden_x);
  const Interval interval = student_t_interval(x, {1, .1}, .99);
  EXPECT_NEAR(std::exp(student_t(x, {1 + interval.low, .1}).log_p_upper), .005, 1e-12);
  EXPECT_NEAR(std::exp(student_t(x, {1 + interval.high, .1}).log_p_lower), .005, 1e-12);
}

Interval interval_of(const Moments& x, const Moments& y, bool relative) {
  return ThetaOfMeans{.test = mean_by_t, .x = {x}, .y = MeanSample{y}, .relative = relative}
      .interval(.95);
}

TEST(WelchT, IntervalEndsAreJustRejected) {
  const Moments x = moments_of(golden_x);
  const Moments y = moments_of(golden_y);
  const Interval difference = interval_of(x, y, false);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1, difference.low}).log_p_upper), .025, 1e-12);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1, difference.high}).log_p_lower), .025, 1e-12);
  const Interval ratio = interval_of(x, y, true);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1 + ratio.low, 0}).log_p_upper), .025, 1e-10);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1 + ratio.high, 0}).log_p_lower), .025, 1e-10);
}

TEST(WelchT, ARatioToAMeanNearZeroIsUnbounded) {
  const Moments x = moments_of(golden_x);
  const Moments y = moments_of(std::vector<double>{-1, 1, .2, -.3});
  const Interval ratio = interval_of(x, y, true);
  EXPECT_EQ(ratio.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(ratio.high, std::numeric_limits<double>::infinity());
}

TEST(WelchT, WhatIsZeroWithoutSpreadIsNoPartOfTheOther) {
  const Moments zeros = moments_of(std::vector<double>(5, 0.0));
  const Interval ratio = interval_of(zeros, moments_of(std::vector{3., 4., 5.}), true);
  EXPECT_EQ(ratio.low, -1);
  EXPECT_EQ(ratio.high, -1);
}

TEST(WelchT, OneConstantSampleCountsAsExactlyKnown) {
  const TestResult result =
      welch_t(moments_of(golden_x), moments_of(std::vector<double>{1, 1, 1}), {});
  EXPECT_NEAR(result.statistic, -.7040427405942026, 1e-14);
  EXPECT_DOUBLE_EQ(result.distribution.parameters.at(0), 9);
}

}  // namespace
}  // namespace assay::stats
