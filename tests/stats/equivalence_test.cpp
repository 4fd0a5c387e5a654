#include "stats/means/equivalence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::golden_x;
using tests::golden_y;
using tests::moments_of;

const Moments x = moments_of(golden_x);
const Moments y = moments_of(golden_y);

TEST(Equivalence, GoldenValuesToThePrintedDigits) {
  const Equivalence result = welch_equivalence(x, y, {-.6, .6});
  EXPECT_NEAR(std::exp(result.at_low.log_p_upper), .328841750041338, 1e-13);
  EXPECT_NEAR(std::exp(result.at_high.log_p_lower), .0205575060229084, 1e-13);
  EXPECT_EQ(result.log_p, result.at_low.log_p_upper);
}

TEST(Equivalence, RejectsExactlyWhenTheIntervalLiesInside) {
  const Interval interval = student_t_interval(x, {1}, 1 - 2 * .05);
  const Equivalence just = student_t_equivalence(x, {1}, {interval.low, 100});
  EXPECT_NEAR(std::exp(just.log_p), .05, 1e-12);
}

TEST(Equivalence, RelativeMarginsAreContrasts) {
  const Equivalence result = welch_relative_equivalence(x, y, {-.5, .5});
  EXPECT_EQ(result.at_low.statistic, welch_t(x, y, {.5, 0}).statistic);
  const Interval ratio = welch_ratio_interval(x, y, .9);
  const Equivalence just = welch_relative_equivalence(x, y, {ratio.low, 50});
  EXPECT_NEAR(std::exp(just.log_p), .05, 1e-9);
}

TEST(Equivalence, NegativeMeansExchangeTheMargins) {
  std::vector<double> minus_x;
  std::vector<double> minus_y;
  for (const double v : golden_x) minus_x.push_back(-v);
  for (const double v : golden_y) minus_y.push_back(-v);
  const Equivalence mirrored =
      welch_relative_equivalence(moments_of(minus_x), moments_of(minus_y), {-.7, .4});
  EXPECT_NEAR(mirrored.log_p, welch_relative_equivalence(x, y, {-.7, .4}).log_p, 1e-12);
}

TEST(Equivalence, InvertedMarginsThrow) {
  EXPECT_THROW(student_t_equivalence(x, {1}, {.1, .1}), std::domain_error);
  EXPECT_THROW(welch_equivalence(x, y, {.2, -.2}), std::domain_error);
  EXPECT_THROW(welch_relative_equivalence(x, y, {-.1, std::nan("")}), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
