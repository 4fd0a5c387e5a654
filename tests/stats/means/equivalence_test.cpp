#include "stats/means/equivalence.h"

#include "stats/means/student_t.h"
#include "stats/means/welch_t.h"
#include "tests/prelude.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

const Moments x = moments_of(golden_x);
const Moments y = moments_of(golden_y);

TEST(Equivalence, GoldenValuesToThePrintedDigits) {
  const Equivalence result = equivalence(welch_t(x, y, {1, -.6}), welch_t(x, y, {1, .6}));
  EXPECT_NEAR(std::exp(result.at_low.log_p_upper), .328841750041338, 1e-13);
  EXPECT_NEAR(std::exp(result.at_high.log_p_lower), .0205575060229084, 1e-13);
  EXPECT_EQ(result.log_p, result.at_low.log_p_upper);
}

TEST(Equivalence, RejectsExactlyWhenTheIntervalLiesInside) {
  const Interval interval = student_t_interval(x, {1}, 1 - 2 * .05);
  const Equivalence just = equivalence(student_t(x, {1 + interval.low}), student_t(x, {101}));
  EXPECT_NEAR(std::exp(just.log_p), .05, 1e-12);
}

}  // namespace
}  // namespace assay::stats
