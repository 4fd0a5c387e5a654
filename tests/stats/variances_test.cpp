#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stats/chi_square_variance.h"
#include "stats/errors.h"
#include "stats/f_ratio.h"
#include "stats/log_variance.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::golden_x;
using tests::golden_y;
using tests::moments_of;

const Moments x = moments_of(golden_x);
const Moments y = moments_of(golden_y);
const Moments constant = moments_of(std::vector<double>{1, 1, 1, 1});

TEST(ChiSquareVariance, GoldenValuesToThePrintedDigits) {
  const TestResult result = chi_square_variance(x, .3);
  EXPECT_NEAR(result.statistic, 16.8793666666667, 1e-12);
  EXPECT_NEAR(std::exp(result.log_p_upper), .0506389375042817, 1e-14);
}

TEST(ChiSquareVariance, IntervalEndsAreJustRejected) {
  const Interval interval = chi_square_variance_interval(x, .98);
  EXPECT_NEAR(std::exp(chi_square_variance(x, interval.low).log_p_upper), .01, 1e-12);
  EXPECT_NEAR(std::exp(chi_square_variance(x, interval.high).log_p_lower), .01, 1e-12);
}

TEST(FRatio, GoldenValuesToThePrintedDigits) {
  const TestResult result = f_ratio(x, y, 1);
  EXPECT_NEAR(result.statistic, .612040106637935, 1e-14);
  EXPECT_NEAR(std::exp(log_p_two_sided(result)), .487284693225179, 1e-13);
}

TEST(FRatio, IntervalEndsAreJustRejected) {
  const Interval interval = f_ratio_interval(x, y, .98);
  EXPECT_NEAR(std::exp(f_ratio(x, y, interval.low).log_p_upper), .01, 1e-12);
  EXPECT_NEAR(std::exp(f_ratio(x, y, interval.high).log_p_lower), .01, 1e-12);
}

TEST(LogVariance, GoldenValuesToThePrintedDigits) {
  const TestResult result = log_variance_ratio(x, y, 1);
  EXPECT_NEAR(result.statistic, -.490957464894935 / .739689287409855, 1e-13);
  const double error = std::hypot(log_variance_standard_error(x), log_variance_standard_error(y));
  EXPECT_NEAR(error, .739689287409855, 1e-14);
}

TEST(LogVariance, IntervalEndsAreJustRejected) {
  const Interval one = log_variance_interval(x, .3, .98);
  EXPECT_NEAR(std::exp(log_variance(x, .3 * std::exp(one.low)).log_p_upper), .01, 1e-12);
  EXPECT_NEAR(std::exp(log_variance(x, .3 * std::exp(one.high)).log_p_lower), .01, 1e-12);
  const Interval two = log_variance_ratio_interval(x, y, .98);
  EXPECT_NEAR(std::exp(log_variance_ratio(x, y, std::exp(two.low)).log_p_upper), .01, 1e-12);
  EXPECT_NEAR(std::exp(log_variance_ratio(x, y, std::exp(two.high)).log_p_lower), .01, 1e-12);
}

TEST(Variances, ConstantSamplesAndBadNullValuesThrow) {
  EXPECT_THROW(chi_square_variance(constant, 1), ZeroVariance);
  EXPECT_THROW(f_ratio(x, constant, 1), ZeroVariance);
  EXPECT_THROW(f_ratio(constant, x, 1), ZeroVariance);
  EXPECT_THROW(log_variance(constant, 1), ZeroVariance);
  EXPECT_THROW(log_variance(moments_of(std::vector<double>{1, 2}), 1), std::domain_error);
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(chi_square_variance(x, bad), std::domain_error);
    EXPECT_THROW(f_ratio(x, y, bad), std::domain_error);
    EXPECT_THROW(log_variance(x, bad), std::domain_error);
    EXPECT_THROW(log_variance_ratio(x, y, bad), std::domain_error);
    EXPECT_THROW(chi_square_variance_interval(x, bad), std::domain_error);
  }
}

}  // namespace
}  // namespace assay::stats
