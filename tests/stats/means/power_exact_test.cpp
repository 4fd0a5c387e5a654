#include "stats/means/power_exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stats/means/two_valued.h"
#include "tests/philox.h"

namespace assay::stats {
namespace {

using tests::Philox;

const ExactMeanPlan coin{
    .range = {0, 1}, .null_mean = 0.5, .rates = {.alpha = 0.05, .beta = 0.1, .two_sided = true}};

// n = 10, two-sided .05: rejected are 9 and 10 heads, P = 10 p^9 (1 - p) + p^10.
TEST(PowerExact, OfACoinIsTheProbabilityOfItsRejectedCounts) {
  const double p = 0.8;
  const double expected = 10 * std::pow(p, 9) * (1 - p) + std::pow(p, 10);
  EXPECT_NEAR(binomial_power(coin, 10, 0.3), expected, 1e-12);
  EXPECT_NEAR(binomial_power(coin, 10, -0.3), expected, 1e-12);
  ExactMeanPlan scaled = coin;
  scaled.range = {-1, 3};
  scaled.null_mean = 1;
  EXPECT_NEAR(binomial_power(scaled, 10, 1.2), expected, 1e-12);
}

TEST(PowerExact, SampleSizesHaveTheirPowerAndAreNearTheLeast) {
  const ExactMeanPlan rare{.range = {0, 1},
                           .null_mean = 0.01,
                           .rates = {.alpha = 0.001, .beta = 0.01, .two_sided = true}};
  for (const double effect : {0.005, -0.005}) {
    const std::uint64_t n = exact_sample_size(ExactMethod::binomial, rare, effect).value();
    EXPECT_GE(binomial_power(rare, n, effect), 0.99);
    EXPECT_LT(binomial_power(rare, n * 9 / 10, effect), 0.99);
  }
  const double found = exact_detectable(ExactMethod::binomial, rare, 20000, 1).value();
  EXPECT_NEAR(binomial_power(rare, 20000, found), 0.99, 1e-6);
  // No probability lies so far below one in a hundred.
  EXPECT_FALSE(exact_detectable(ExactMethod::binomial, rare, 100, -1).has_value());
}

// 1000 runs at the planned size, which promises .99. Fewer than .96 have probability below 1e-12.
// The bound is conservative, so more are found.
TEST(PowerExact, ABoundedMeanIsFoundAtThePlannedSize) {
  const ExactMeanPlan plan{.range = {0, 1},
                           .null_mean = 0.45,
                           .standard_deviation = std::sqrt(1 / 12.0),
                           .rates = {.alpha = 0.01, .beta = 0.01, .two_sided = true}};
  const std::uint64_t n = exact_sample_size(ExactMethod::bounded, plan, 0.05).value();
  EXPECT_GE(bounded_power(plan, n, 0.05), 0.99);
  Philox random(1);
  int failed = 0;
  int passed = 0;
  constexpr int runs = 1000;
  for (int k = 0; k < runs; ++k) {
    Moments x;
    for (std::uint64_t i = 0; i < n; ++i) x.add(random.uniform());
    failed += bounded_mean(x, plan.range, 0.45).log_p_upper <= std::log(0.005) ? 1 : 0;
    passed += bounded_mean(x, plan.range, 0.55).log_p_lower <= std::log(0.01) ? 1 : 0;
  }
  EXPECT_GE(failed, 960);
  EXPECT_GE(passed, 960);
}

TEST(PowerExact, RefusesWhatIsNoPlan) {
  EXPECT_THROW(binomial_power(coin, 0, 0.1), std::domain_error);
  EXPECT_THROW(binomial_power(coin, 10, 0), std::domain_error);
  EXPECT_THROW(bounded_power(coin, 1, 0.1), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
