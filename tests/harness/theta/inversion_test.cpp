#include "harness/theta/decision.h"
#include "stats/means/student_t.h"
#include "tests/prelude.h"
#include "tests/stats/samples.h"

namespace assay::harness {
namespace {

// The numerical inverse has a closed form here: mean -+ t s / sqrt n.
TEST(Inversion, OfStudentTIsItsInterval) {
  const stats::Moments x = tests::moments_of(tests::golden_x);
  for (const double confidence : {.5, .9, .99, 1 - 1e-8}) {
    const stats::Interval closed = stats::student_t_interval(x, {.value = .5}, confidence);
    const stats::Interval inverted = interval_by_inversion(
        [&](double theta) { return stats::student_t(x, {.value = .5 + theta}); },
        {.estimate = x.mean - .5, .step = x.standard_error()}, confidence);
    EXPECT_NEAR(inverted.low, closed.low, 1e-9) << confidence;
    EXPECT_NEAR(inverted.high, closed.high, 1e-9) << confidence;
    EXPECT_EQ(inverted.confidence, confidence);
  }
}

// The reference's own error enters the closed form as well.
TEST(Inversion, OfStudentTAgainstAnUncertainReferenceIsItsInterval) {
  const stats::Moments x = tests::moments_of(tests::golden_x);
  const stats::Interval closed = stats::student_t_interval(x, {.5, .3}, .95);
  const stats::Interval inverted = interval_by_inversion(
      [&](double theta) {
        return stats::student_t(x, {.value = .5 + theta, .standard_error = .3});
      },
      {.estimate = x.mean - .5, .step = 1e-3}, .95);
  EXPECT_NEAR(inverted.low, closed.low, 1e-9);
  EXPECT_NEAR(inverted.high, closed.high, 1e-9);
}

TEST(Inversion, OfWhatIsNeverRejectedIsTheWholeLine) {
  const stats::Interval interval =
      interval_by_inversion([](double) { return stats::TestResult{}; }, {}, .9);
  EXPECT_EQ(interval.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(interval.high, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace assay::harness
