#include "reports/record/record.h"

#include "reports/words/describe.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

TEST(Standing, FollowsVerdictAndExpectation) {
  EXPECT_EQ(standing(judged(Verdict::pass)), Standing::holds);
  EXPECT_EQ(standing(judged(Verdict::fail, Verdict::fail)), Standing::caught);
  EXPECT_EQ(standing(judged(Verdict::pass, Verdict::fail)), Standing::broken);
  EXPECT_EQ(standing(judged(Verdict::invalid)), Standing::no_verdict);
  EXPECT_EQ(standing(judged(Verdict::error)), Standing::no_verdict);
  EXPECT_EQ(standing(judged(Verdict::inconclusive, Verdict::fail)), Standing::undecided);
  EXPECT_EQ(standing(judged(Verdict::skipped)), Standing::not_run);
}

Sample drawn(const std::string& stream, std::uint64_t primaries, std::uint64_t secondaries) {
  Sample sample;
  sample.plugin = "path/plain";
  sample.stream = stream;
  sample.primaries = primaries;
  sample.secondaries = secondaries;
  const double seconds = 5 * static_cast<double>(secondaries);
  sample.cost = {.camera_rays = secondaries,
                 .closest_hit_rays = 2 * secondaries,
                 .shadow_rays = 3 * secondaries,
                 .samples = primaries * secondaries,
                 .seconds = seconds};
  return sample;
}

TEST(Cost, CountsDrawsOnceHoweverManyChannelsTheyHave) {
  reports::Test test;
  Sample red = drawn("1", 4, 1);
  red.channel = "R";
  Sample green = red;
  green.channel = "G";
  test.samples = {red, green, drawn("2", 4, 1)};
  EXPECT_EQ(total_cost(test).samples, 8u);
  EXPECT_EQ(rays(total_cost(test)), 12u);
  EXPECT_EQ(total_cost(test).seconds, 10);
}

// A sweep draws one stream with several numbers of primaries.
TEST(Cost, CountsEveryPointOfASweep) {
  reports::Test test;
  test.samples = {drawn("1", 8, 100), drawn("1", 16, 100), drawn("1", 32, 100)};
  EXPECT_EQ(total_cost(test).samples, 5600u);
}

TEST(Cost, OfASuiteCountsSharedDrawsAsFarAsTheLongestReaches) {
  Suite suite;
  suite.tests.resize(2);
  suite.tests[0].samples = {drawn("1", 4, 100), drawn("2", 4, 50)};
  suite.tests[1].samples = {drawn("1", 4, 300), drawn("1", 8, 10)};
  EXPECT_EQ(total_cost(suite).samples, 4u * 300 + 4u * 50 + 8u * 10);
}

}  // namespace
}  // namespace assay::reports
