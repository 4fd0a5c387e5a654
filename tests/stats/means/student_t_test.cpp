#include "stats/means/student_t.h"

#include "stats/basics/errors.h"
#include "tests/prelude.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

TEST(StudentT, GoldenValuesToThePrintedDigits) {
  const TestResult result = student_t(moments_of(golden_x), {1});
  EXPECT_NEAR(result.statistic, -.7040427405942026, 1e-14);
  EXPECT_NEAR(std::exp(log_p_two_sided(result)), .49921572992616514, 1e-14);
  EXPECT_EQ(result.distribution.family, "student-t");
  EXPECT_EQ(result.distribution.parameters.at(0), 9);
  EXPECT_EQ(result.exactness, Exactness::exact);
}

TEST(StudentT, ASmallMeanGivesASmallLowerTail) {
  const TestResult result = student_t(moments_of(golden_x), {3});
  EXPECT_LT(result.log_p_lower, std::log(1e-4));
  EXPECT_GT(result.log_p_upper, std::log(.99));
}

TEST(StudentT, AReferenceErrorEntersVarianceAndDegreesOfFreedom) {
  const Moments x = moments_of(golden_x);
  const double own = x.variance() / 10;
  const TestResult result = student_t(x, {1, std::sqrt(own)});
  EXPECT_NEAR(result.statistic, -.7040427405942026 / std::sqrt(2), 1e-14);
  EXPECT_NEAR(result.distribution.parameters.at(0), 36, 1e-12);
  EXPECT_EQ(result.exactness, Exactness::asymptotic);
}

TEST(StudentT, TheIntervalEndsAreJustRejected) {
  const Moments x = moments_of(golden_x);
  const Interval interval = student_t_interval(x, {1, .1}, .99);
  EXPECT_NEAR(std::exp(student_t(x, {1 + interval.low, .1}).log_p_upper), .005, 1e-12);
  EXPECT_NEAR(std::exp(student_t(x, {1 + interval.high, .1}).log_p_lower), .005, 1e-12);
}

TEST(StudentT, AHopelessMeanHasAFiniteLogarithm) {
  Moments x = moments_of(golden_x);
  const TestResult result = student_t(x, {1e9});
  EXPECT_TRUE(std::isfinite(log_p_two_sided(result)));
  EXPECT_LT(log_p_two_sided(result), -150);
}

TEST(StudentT, BadArgumentsAreNamed) {
  const Moments x = moments_of(golden_x);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(student_t(moments_of(std::vector<double>{1}), {0}), std::domain_error);
  EXPECT_THROW(student_t(moments_of(std::vector<double>{1, 1, 1}), {0}), ZeroVariance);
  EXPECT_THROW(student_t(x, {nan}), std::domain_error);
  EXPECT_THROW(student_t(x, {0, -1}), std::domain_error);
  EXPECT_THROW(student_t_interval(x, {0}, 1), std::domain_error);
  EXPECT_THROW(student_t_interval(x, {0}, nan), std::domain_error);
  try {
    student_t(x, {0, -1});
    FAIL() << "no exception";
  } catch (const std::domain_error& error) {
    EXPECT_STREQ(error.what(),
                 "student_t: reference standard error = -1, must be non-negative and finite");
  }
}

}  // namespace
}  // namespace assay::stats
