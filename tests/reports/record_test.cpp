#include "reports/record.h"

#include <gtest/gtest.h>

#include "reports/describe.h"
#include "reports/verdict.h"
#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

reports::Test with(Verdict verdict, Verdict expected, bool ok) {
  reports::Test test;
  test.verdict = verdict;
  test.expected = expected;
  test.ok = ok;
  return test;
}

TEST(Outcome, FollowsVerdictAndExpectation) {
  EXPECT_EQ(outcome(with(Verdict::pass, Verdict::pass, true)), Outcome::passed);
  EXPECT_EQ(outcome(with(Verdict::fail, Verdict::fail, true)), Outcome::passed);
  EXPECT_EQ(outcome(with(Verdict::pass, Verdict::fail, false)), Outcome::failed);
  EXPECT_EQ(outcome(with(Verdict::invalid, Verdict::pass, false)), Outcome::failed);
  EXPECT_EQ(outcome(with(Verdict::error, Verdict::pass, false)), Outcome::failed);
  EXPECT_EQ(outcome(with(Verdict::inconclusive, Verdict::fail, false)), Outcome::inconclusive);
  EXPECT_EQ(outcome(with(Verdict::skipped, Verdict::pass, false)), Outcome::skipped);
}

TEST(Tally, CountsEveryTestOnce) {
  const Tally counts = tally(example_record());
  EXPECT_EQ(counts.passed, 5);
  EXPECT_EQ(counts.failed, 5);
  EXPECT_EQ(counts.inconclusive, 2);
  EXPECT_EQ(counts.skipped, 1);
  EXPECT_EQ(tally_sentence(counts), "5 of 13\u00A0tests not ok");
  EXPECT_EQ(tally_sentence({}), "No test ran");
  EXPECT_EQ(tally_sentence({.passed = 3}), "All 3 tests ok");
  EXPECT_EQ(tally_sentence({.passed = 3, .inconclusive = 1}),
            "1 of 4\u00A0tests undecided, none not ok");
}

TEST(Cost, CountsAnEstimatorOnceHoweverManyChannelsItHas) {
  reports::Test test;
  Sample red;
  red.estimator = "path";
  red.channel = "R";
  red.cost = {
      .camera_rays = 1, .closest_hit_rays = 2, .shadow_rays = 3, .samples = 4, .seconds = 5};
  Sample green = red;
  green.channel = "G";
  Sample other = red;
  other.estimator = "direct";
  test.samples = {red, green, other};
  EXPECT_EQ(total_cost(test).samples, 8u);
  EXPECT_EQ(rays(total_cost(test)), 12u);
  EXPECT_EQ(total_cost(test).seconds, 10);
}

}  // namespace
}  // namespace assay::reports
