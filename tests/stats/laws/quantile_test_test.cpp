#include "stats/laws/quantile_test.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

std::vector<double> sample(int k, double size) { return sorted(table_sample(k, size)); }

TEST(QuantileTest, AgreesWithEnumeration) {
  for (const Row& row : tests::read_table("quantile")) {
    const int k = static_cast<int>(row["k"]);
    SCOPED_TRACE(k);
    const auto x = sample(k, row["n"]);
    const auto y = sample(k + 3, row["m"]);
    const TestResult one = quantile_test(count_around(x, .3 * k + .5), row["q"]);
    EXPECT_NEAR(std::exp(one.log_p_lower) / row["lower"], 1, 1e-9);
    EXPECT_NEAR(std::exp(one.log_p_upper) / row["upper"], 1, 1e-9);
    const Interval interval = quantile_interval(x, row["q"], .99);
    expect_near_or_infinite(interval.low, row["low"], 1e-12);
    expect_near_or_infinite(interval.high, row["high"], 1e-12);
    const TestResult two = quantile_compare(x, y, row["q"], .1 * k);
    EXPECT_NEAR(std::exp(two.log_p_lower) / row["compare_lower"], 1, 1e-9);
    EXPECT_NEAR(std::exp(two.log_p_upper) / row["compare_upper"], 1, 1e-9);
  }
}

TEST(QuantileTest, IntervalHoldsExactlyTheValuesThatAreNotRejected) {
  const auto x = sample(1, 60);
  const Interval interval = quantile_interval(x, .3, .9);
  const auto rejected = [&](double v) {
    const TestResult result = quantile_test(count_around(x, v), .3);
    return std::min(result.log_p_lower, result.log_p_upper) <= std::log(.05);
  };
  EXPECT_FALSE(rejected(interval.low));
  EXPECT_FALSE(rejected(interval.high));
  EXPECT_TRUE(rejected(std::nextafter(interval.low, -10)));
  EXPECT_TRUE(rejected(std::nextafter(interval.high, 10)));
}

TEST(QuantileTest, AnAtomThatHoldsTheQuantileIsNeverRejected) {
  const TestResult result = quantile_test({.below = 20, .at_most = 90, .n = 100}, .5);
  EXPECT_GT(result.log_p_lower, std::log(.9));
  EXPECT_GT(result.log_p_upper, std::log(.9));
}

TEST(QuantileTest, TheDifferenceIntervalEndsWhereTheTestIsAtItsLevel) {
  const auto x = sample(2, 200);
  const auto y = sample(5, 150);
  const Interval interval = quantile_difference_interval(x, y, .5, .98);
  EXPECT_LT(interval.low, interval.high);
  const auto at = [&](double offset) { return quantile_compare(x, y, .5, offset); };
  EXPECT_GT(at(interval.low).log_p_upper, std::log(.01));
  EXPECT_LE(at(interval.low - 1e-9).log_p_upper, std::log(.01));
  EXPECT_GT(at(interval.high).log_p_lower, std::log(.01));
  EXPECT_LE(at(interval.high + 1e-9).log_p_lower, std::log(.01));
  const Interval unbounded = quantile_difference_interval(sample(1, 5), sample(2, 5), .9, .99);
  EXPECT_TRUE(std::isinf(unbounded.low) && std::isinf(unbounded.high));
}

TEST(QuantileTest, AnOffsetMovesTheSecondSample) {
  const auto x = sample(1, 100);
  std::vector<double> y = sample(2, 80);
  const TestResult moved = quantile_compare(x, y, .7, .5);
  for (double& value : y) value += .5;
  EXPECT_EQ(moved.log_p_upper, quantile_compare(x, y, .7).log_p_upper);
  EXPECT_EQ(moved.log_p_lower, quantile_compare(x, y, .7).log_p_lower);
}

TEST(QuantileTest, FarApartSamplesKeepAFiniteLogarithm) {
  const std::vector<double> x(3000, 0.0);
  const std::vector<double> y(3000, 1.0);
  const TestResult result = quantile_compare(x, y, .5);
  EXPECT_NEAR(result.log_p_lower, -3000 * std::numbers::ln2 + std::log1p(3000 * std::numbers::ln2),
              1e-6);
  EXPECT_EQ(result.log_p_upper, 0);
}

TAILS_CALIBRATED(QuantileTest, BothSidesAreAtMostUniform, 331, 20000, Shape::at_most_uniform) {
  const double truth = -std::log(.1);  // the .9 quantile of exp(1)
  const auto x = sorted(sample_of(80, [&] { return random.exponential(); }));
  return quantile_test(count_around(x, truth), .9);
}

// Half the values are clamped at 1, so the median is exactly there.
std::vector<double> clamped(Philox& random, std::size_t n) {
  return sorted(sample_of(n, [&] { return std::min(1.0, 2 * random.uniform()); }));
}

CALIBRATED(QuantileTest, AnAtomAtTheQuantileKeepsTheLevel, 333, 20000, Shape::at_most_uniform) {
  return log_p_two_sided(quantile_test(count_around(clamped(random, 60), 1), .5));
}

CAUGHT(QuantileTest, CountingTiesBelowIsCaught, 334, 20000, Shape::at_most_uniform) {
  QuantileCounts counts = count_around(clamped(random, 60), 1);
  counts.below = counts.at_most;
  return quantile_test(counts, .5).log_p_lower;
}

CAUGHT(QuantileTest, ATailThatLeavesOutTheObservedCountIsCaught, 335, 20000,
       Shape::at_most_uniform) {
  const auto x = sorted(sample_of(30, [&] { return random.uniform(); }));
  const auto counts = count_around(x, .5);
  return counts.below == 30 ? -690.0 : binomial_tails(counts.below + 1, {30, .5}).upper;
}

// Medians of exp(1) and of a uniform law on (0, 2 ln 2).
TAILS_CALIBRATED(QuantileTest, ComparisonIsAtMostUniformForUnequalShapes, 336, 4000,
                 Shape::at_most_uniform) {
  const auto x = sorted(sample_of(60, [&] { return random.exponential(); }));
  const auto y = sorted(sample_of(40, [&] { return 2 * std::numbers::ln2 * random.uniform(); }));
  return quantile_compare(x, y, .5);
}

// The sample quantile of x is read as if it were known: the binomial p-value of y at it.
CAUGHT(QuantileTest, TwoPValuesAtTheMedianOfXAloneAreCaught, 338, 4000, Shape::at_most_uniform) {
  const auto x = sorted(sample_of(61, [&] { return random.exponential(); }));
  const auto y = sorted(sample_of(61, [&] { return random.exponential(); }));
  return quantile_test(count_around(y, x[30]), .5).log_p_lower;
}

TEST(QuantileTest, TheNormalLimitOfAMedianIsPiHalves) {
  const double density = 1 / std::sqrt(2 * std::numbers::pi);
  EXPECT_NEAR(quantile_standard_deviation(.5, density), std::sqrt(std::numbers::pi / 2), 1e-12);
}

TEST(Quantile, StandsWhereTheCountsAgree) {
  EXPECT_EQ(sample_quantile_rank(5, 0.5), 2U);
  EXPECT_EQ(sample_quantile_rank(4, 0.25), 1U);
  EXPECT_EQ(sample_quantile_rank(4, 1), 3U);
  EXPECT_EQ(sample_quantile_rank(100, 0.29), 29U);
}

}  // namespace
}  // namespace assay::stats
