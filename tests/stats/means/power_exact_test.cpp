#include "stats/means/power_exact.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

const ExactMeanPlan coin{
    .range = {0, 1}, .null_mean = 0.5, .rates = {.alpha = 0.05, .beta = 0.1, .two_sided = true}};

// n = 10, two-sided .05: rejected are 9 and 10 heads, P = 10 p^9 (1 - p) + p^10.
TEST(PowerExact, OfACoinIsTheProbabilityOfItsRejectedCounts) {
  const double p = 0.8;
  const double expected = 10 * std::pow(p, 9) * (1 - p) + std::pow(p, 10);
  EXPECT_NEAR(binomial_planning.power(coin, 10, 0.3), expected, 1e-12);
  EXPECT_NEAR(binomial_planning.power(coin, 10, -0.3), expected, 1e-12);
  ExactMeanPlan scaled = coin;
  scaled.range = {-1, 3};
  scaled.null_mean = 1;
  EXPECT_NEAR(binomial_planning.power(scaled, 10, 1.2), expected, 1e-12);
}

TEST(PowerExact, SampleSizesHaveTheirPowerAndAreNearTheLeast) {
  const ExactMeanPlan rare{.range = {0, 1},
                           .null_mean = 0.01,
                           .rates = {.alpha = 0.001, .beta = 0.01, .two_sided = true}};
  for (const double effect : {0.005, -0.005}) {
    const std::uint64_t n = binomial_planning.sample_size(rare, effect).value();
    EXPECT_GE(binomial_planning.power(rare, n, effect), 0.99);
    EXPECT_LT(binomial_planning.power(rare, n * 9 / 10, effect), 0.99);
  }
  const double found = exact_detectable(binomial_planning, rare, 20000, 1).value();
  EXPECT_NEAR(binomial_planning.power(rare, 20000, found), 0.99, 1e-6);
  // No probability lies so far below one in a hundred.
  EXPECT_FALSE(exact_detectable(binomial_planning, rare, 100, -1).has_value());
}

// At the planned size, which promises .99, fewer than .96 of 1000 have probability below 1e-12.
// Other bets of the mixture only add to what is found.
TEST(PowerExact, BetsFindAMeanAtThePlannedSize) {
  Philox random(1);
  const auto exponential = tests::draw_values(tests::laws::exponential, 5000, random);
  const auto uniform = tests::draw_values(tests::laws::uniform, 5000, random);
  struct Case {
    const tests::Law& law;
    Range range;
    const std::vector<double>& pilot;
  };
  const Case cases[] = {{tests::laws::uniform, {0, 1}, uniform},
                        {tests::laws::exponential, {0, 40}, exponential}};
  for (const Case& each : cases) {
    const ValueCells law(each.pilot);
    const ErrorRates rates{.alpha = 0.01, .beta = 0.01, .two_sided = true};
    for (const double effect : {.1 * each.law.mean, -.4 * each.law.mean}) {
      const ExactMeanPlan plan{
          .range = each.range, .null_mean = each.law.mean - effect, .law = &law, .rates = rates};
      const std::uint64_t n = betting_planning.sample_size(plan, effect).value();
      EXPECT_GE(betting_planning.power(plan, n, effect), 0.99 - 1e-9);
      EXPECT_LT(betting_planning.power(plan, n * 9 / 10, effect), 0.99);
      int found = 0;
      for (int run = 0; run < 1000; ++run) {
        const ValueCells x(tests::draw_values(each.law, n, random));
        const TestResult result = betting_mean(x, each.range, plan.null_mean);
        found += (effect > 0 ? result.log_p_upper : result.log_p_lower) <= std::log(0.005);
      }
      EXPECT_GE(found, 960) << each.law.name << effect << " at " << n;
      std::cout << "  " << each.law.name << ", effect " << effect << ": " << found << " at " << n
                << "\n";
    }
  }
}

TEST(PowerExact, BetsFindNothingBeyondAnInfiniteEnd) {
  const ValueCells law(std::vector<double>{0, 1, 2});
  const ExactMeanPlan plan{.range = {0, std::numeric_limits<double>::infinity()},
                           .null_mean = 1,
                           .law = &law,
                           .rates = {.alpha = 0.01, .beta = 0.01, .two_sided = false}};
  EXPECT_EQ(betting_planning.power(plan, 1000000, -.5), 0);
  EXPECT_FALSE(betting_planning.sample_size(plan, -.5).has_value());
  EXPECT_FALSE(exact_detectable(betting_planning, plan, 1000000, -1).has_value());
  const double found = exact_detectable(betting_planning, plan, 10000, 1).value();
  EXPECT_NEAR(betting_planning.power(plan, 10000, found), .99, 1e-6);
}

}  // namespace
}  // namespace assay::stats
