// Plans of variances and costs: methods, floors and sizes.

#include "harness/plan/sizes.h"
#include "stats/planning/power.h"
#include "tests/harness/planned.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

// A ratio of sums over 4096 is near normal, which a pilot of 512 leaves in doubt. Means of 64
// normal values are normal by any pilot.
TEST(Plan, TakesTheExactTestOnlyWhereThePilotLeavesNoDoubt) {
  const Prepared planned = plan_text(
      "  - {name: few, claim: variance(ratio) <= 1}\n"
      "  - {name: averaged, claim: variance(normal) <= 100}\n"
      "  - {name: one of two, claim: variance(normal) < variance(ratio)}\n"
      "  - {name: forced, claim: variance(ratio) <= 1, test: chi-square}\n");
  EXPECT_EQ(planned.plans[0].method.name, "influence-t");
  EXPECT_EQ(planned.plans[1].method.name, "chi-square");
  EXPECT_EQ(planned.plans[2].method.name, "influence-t");
  EXPECT_EQ(planned.plans[3].method.name, "chi-square");
  for (const Plan& plan : planned.plans) EXPECT_EQ(plan.invalid, "");
}

// No first look lies below the floor, in primaries and in observations.
TEST(Plan, OfInfluenceValuesTakesTheFloorOfEvidence) {
  const Prepared planned = plan_text(
      "  - {name: single, claim: variance(heavier-single) <= 100, detect: 50%}\n"
      "  - {name: many primaries, claim: variance(ratio) <= 1, detect: 50%}\n"
      "  - {name: cost, claim: cost(multi) <= 2, detect: 50%}\n"
      "  - {name: all together, claim: total_variance(single) <= 1, detect: 50%}\n");
  for (const std::size_t test : {0UL, 2UL, 3UL}) {
    EXPECT_GE(planned.plans[test].looks.sizes.front(), floor_of_evidence) << test;
  }
  EXPECT_GE(planned.plans[1].looks.sizes.front(), usual_secondaries);
  EXPECT_LT(planned.plans[1].looks.sizes.front(), floor_of_evidence);
}

// Given `secondaries` are a floor of their own.
TEST(Plan, GivenSecondariesAreTaken) {
  const Prepared planned =
      plan_text("  - {claim: variance(heavier-single) <= 100, secondaries: 2000}\n");
  EXPECT_EQ(planned.plans[0].looks.sizes, std::vector<std::uint64_t>{2000});
}

// Normal values, by their relative influence values of variance 2. Looks take some 8 % more than
// one, and a pilot of 8192 knows the kurtosis to 11 % of n, 1e-4.
TEST(Plan, OfVariancesHasTheSizeOfTheirInfluenceValues) {
  const Prepared planned = plan_text(
      "  - {name: one, claim: variance(single) <= 1, detect: 1%}\n"
      "  - {name: two, claim: variance(single) <= variance(single), detect: 1%}\n");
  const auto size = [&](std::size_t test, double variance) {
    const ErrorShare share = planned.place[test].share;
    const double n =
        stats::normal_sample_size(std::sqrt(variance), {.detect = std::log(1.01)},
                                  {.alpha = share.alpha, .beta = share.beta, .two_sided = false});
    return static_cast<double>(planned.plans[test].most_secondaries()) / n;
  };
  EXPECT_NEAR(size(0, 2), 1.08, .14);
  EXPECT_NEAR(size(1, 4), 1.08, .14);
}

}  // namespace
}  // namespace assay::harness
