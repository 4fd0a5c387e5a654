#include "stats/means/welch_t.h"

#include "stats/basics/errors.h"
#include "tests/prelude.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

TEST(WelchT, GoldenValuesToThePrintedDigits) {
  const TestResult result = welch_t(moments_of(golden_x), moments_of(golden_y), {});
  EXPECT_NEAR(result.statistic, -.9297996148556845, 1e-14);
  EXPECT_NEAR(result.distribution.parameters.at(0), 10.9076975261363, 1e-12);
  EXPECT_NEAR(std::exp(log_p_two_sided(result)), .3725950590942638, 1e-13);
}

TEST(WelchT, AContrastScalesTheSecondSample) {
  std::vector<double> scaled;
  for (const double y : golden_y) scaled.push_back(1.25 * y);
  const TestResult direct = welch_t(moments_of(golden_x), moments_of(scaled), {1, .3});
  const TestResult contrast = welch_t(moments_of(golden_x), moments_of(golden_y), {1.25, .3});
  EXPECT_NEAR(direct.statistic, contrast.statistic, 1e-14);
  EXPECT_NEAR(direct.log_p_lower, contrast.log_p_lower, 1e-12);
}

TEST(WelchT, IntervalEndsAreJustRejected) {
  const Moments x = moments_of(golden_x);
  const Moments y = moments_of(golden_y);
  const Interval difference = welch_t_interval(x, y, .95);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1, difference.low}).log_p_upper), .025, 1e-12);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1, difference.high}).log_p_lower), .025, 1e-12);
  const Interval ratio = welch_ratio_interval(x, y, .95);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1 + ratio.low, 0}).log_p_upper), .025, 1e-10);
  EXPECT_NEAR(std::exp(welch_t(x, y, {1 + ratio.high, 0}).log_p_lower), .025, 1e-10);
}

TEST(WelchT, ARatioToAMeanNearZeroIsUnbounded) {
  const Moments x = moments_of(golden_x);
  const Moments y = moments_of(std::vector<double>{-1, 1, .2, -.3});
  const Interval ratio = welch_ratio_interval(x, y, .95);
  EXPECT_EQ(ratio.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(ratio.high, std::numeric_limits<double>::infinity());
}

TEST(WelchT, OneConstantSampleCountsAsExactlyKnown) {
  const TestResult result =
      welch_t(moments_of(golden_x), moments_of(std::vector<double>{1, 1, 1}), {});
  EXPECT_NEAR(result.statistic, -.7040427405942026, 1e-14);
  EXPECT_DOUBLE_EQ(result.distribution.parameters.at(0), 9);
}

TEST(WelchT, BadArgumentsThrow) {
  const Moments x = moments_of(golden_x);
  const Moments constant = moments_of(std::vector<double>{1, 1, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(welch_t(constant, constant, {}), ZeroVariance);
  EXPECT_THROW(welch_t(x, moments_of(std::vector<double>{1}), {}), std::domain_error);
  EXPECT_THROW(welch_t(x, x, {nan, 0}), std::domain_error);
  EXPECT_THROW(welch_t(x, x, {1, nan}), std::domain_error);
  EXPECT_THROW(welch_ratio_interval(x, x, 0), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
