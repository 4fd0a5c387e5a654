#include "stats/means/student_t.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

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

}  // namespace
}  // namespace assay::stats
