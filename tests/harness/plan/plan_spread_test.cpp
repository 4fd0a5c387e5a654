// Plans of variances and costs: how normal, how heavy and how skewed the pilot shows them to be.

#include <gtest/gtest.h>

#include "harness/plan/critical.h"
#include "stats/gates/assumption_gates.h"
#include "tests/harness/planned.h"

namespace assay::harness {
namespace {

// A ratio of sums over 4096 is near normal. One pilot of 512 in four shows a kurtosis beyond the
// bound.
TEST(Plan, OfFewNearNormalObservationsChiSquareStands) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Planned few = plan_text("  - {claim: variance(ratio) <= 1, secondaries: 500}\n", seed);
    EXPECT_EQ(few.plans[0].method.name, "chi-square") << seed;
    EXPECT_EQ(few.plans[0].invalid, "") << seed;
  }
  const Planned skewed = plan_text("  - {claim: variance(corners) <= 100, secondaries: 500}\n");
  EXPECT_NE(skewed.plans[0].invalid, "");
}

// Each plan allows for the kurtosis that the pilot cannot exclude, beyond what the test bears. That
// is some .36 with 512 values, and next to nothing with 8192 primaries in means of 64. A forced
// test does not allow for it.
TEST(Plan, OfFewNearNormalObservationsTheirKurtosisIsAllowedFor) {
  const Planned planned = plan_text(
      "  - {name: few, claim: variance(ratio) <= 1, secondaries: 500}\n"
      "  - {name: forced, claim: variance(ratio) <= 1, secondaries: 500, test: chi-square}\n"
      "  - {name: averaged, claim: variance(normal) <= 100, secondaries: 500}\n"
      "  - {name: one of two, claim: variance(normal) < variance(ratio), secondaries: 500}\n");
  const auto allowed = [&](std::size_t test) {
    return planned.plans[test].method.frozen.excess_kurtosis(0);
  };
  const Pilot& pilot = *pilot_of(planned.asked->questions[0].subjects[0], planned.pilots);
  const double limit = stats::kurtosis_upper_limit(pilot.sums->moments(0));
  EXPECT_GT(limit, 0.2);
  EXPECT_EQ(allowed(0).x, limit);
  EXPECT_EQ(allowed(1).x, 0);
  EXPECT_EQ(allowed(2).x, 0);
  EXPECT_EQ(planned.plans[3].method.name, "F");
  EXPECT_EQ(allowed(3).x, 0);
  EXPECT_EQ(allowed(3).y, limit);
}

// Variances of eight fair coins are skewed to the left (-2.2), and so is the logarithm of their
// mean. Variances of normal values are not.
TEST(Plan, OfTotalVariancesTheGroupsAreNearNormal) {
  const Planned planned = plan_text(
      "  - {name: coin, claim: total_variance(coin) <= 0.25}\n"
      "  - {name: normal, claim: total_variance(single) <= 1}\n");
  EXPECT_GT(planned.plans[0].most_secondaries(), 10000);
  EXPECT_LT(planned.plans[1].most_secondaries(), 2 * usual_secondaries);
  EXPECT_EQ(planned.plans[0].invalid, "");
}

// The draws decide nothing, so there are no more than a test without `detect` takes.
TEST(Plan, OfAClaimThatIsInvalidDrawsLittle) {
  const Planned planned = plan_text(
      "  - {claim: variance(heavier-single) <= 100, detect: 1%}\n"
      "  - {name: as many as asked for, claim: variance(heavier-single) <= 100, secondaries: "
      "2000}\n");
  ASSERT_FALSE(planned.plans[0].invalid.empty());
  EXPECT_EQ(planned.plans[0].looks.sizes, std::vector<std::uint64_t>{usual_secondaries});
  EXPECT_EQ(planned.plans[1].looks.sizes, std::vector<std::uint64_t>{2000});
}

// Both pilots of 512 values show a heavy tail, with kurtoses of some 500 and of 23. In 400,000
// values the second has a kurtosis of 24.
TEST(Plan, OfFewValuesATailIsHeavyWhereTheKurtosisIsToo) {
  const Planned heavy = plan_text("  - {claim: variance(corners) <= 100}\n");
  EXPECT_NE(heavy.plans[0].invalid.find("tail is too heavy"), std::string::npos);
  const Planned light = plan_text("  - {claim: variance(same-samples) <= 100}\n");
  EXPECT_EQ(light.plans[0].invalid, "");
}

// Two rays, and one where the first finds nothing: a skewness of -6.5.
TEST(Plan, SkewedCostsTakeMoreObservations) {
  const Planned open = plan_text("  - {claim: cost(multi) <= 2}\n");
  EXPECT_GT(open.plans[0].most_secondaries(), 5000);
  EXPECT_EQ(open.plans[0].invalid, "");
  const Planned fixed = plan_text("  - {claim: cost(multi) <= 2, secondaries: 1000}\n");
  EXPECT_NE(fixed.plans[0].invalid.find("costs of this shape"), std::string::npos);
  const Planned constant = plan_text("  - {claim: cost(hemisphere) <= 2, secondaries: 100}\n");
  EXPECT_EQ(constant.plans[0].invalid, "");
}

}  // namespace
}  // namespace assay::harness
