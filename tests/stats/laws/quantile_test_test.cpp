#include "stats/laws/quantile_test.h"

#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

// The data sets of make_ratios.py.
std::vector<double> sample(int k, double size) {
  std::vector<double> values;
  for (int i = 1; i <= static_cast<int>(size); ++i) {
    const double tooth = 1 + std::fmod(0.05 * k * i, 3);
    values.push_back(std::cos(i * (0.7 + 0.1 * k)) * tooth + 0.01 * k * i + 0.3 * k);
  }
  return sorted(values);
}

void expect_near_or_equal(double value, double expected) {
  if (std::isinf(expected)) {
    EXPECT_EQ(value, expected);
  } else {
    EXPECT_NEAR(value, expected, 1e-12);
  }
}

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
    expect_near_or_equal(interval.low, row["low"]);
    expect_near_or_equal(interval.high, row["high"]);
    const TestResult two = quantile_compare(x, y, {row["q"], 1, .1 * k});
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
  const auto at = [&](double offset) { return quantile_compare(x, y, {.5, 1, offset}); };
  EXPECT_GT(at(interval.low).log_p_upper, std::log(.01));
  EXPECT_LE(at(interval.low - 1e-9).log_p_upper, std::log(.01));
  EXPECT_GT(at(interval.high).log_p_lower, std::log(.01));
  EXPECT_LE(at(interval.high + 1e-9).log_p_lower, std::log(.01));
  const Interval unbounded = quantile_difference_interval(sample(1, 5), sample(2, 5), .9, .99);
  EXPECT_TRUE(std::isinf(unbounded.low) && std::isinf(unbounded.high));
}

TEST(QuantileTest, AScaleStretchesTheSecondSample) {
  const auto x = sample(1, 100);
  std::vector<double> y = sample(2, 80);
  const TestResult scaled = quantile_compare(x, y, {.7, 3, .5});
  for (double& value : y) value = 3 * value + .5;
  EXPECT_EQ(scaled.log_p_upper, quantile_compare(x, y, {.7}).log_p_upper);
  EXPECT_EQ(scaled.log_p_lower, quantile_compare(x, y, {.7}).log_p_lower);
}

TEST(QuantileTest, FarApartSamplesKeepAFiniteLogarithm) {
  const std::vector<double> x(3000, 0.0);
  const std::vector<double> y(3000, 1.0);
  const TestResult result = quantile_compare(x, y, {.5});
  EXPECT_NEAR(result.log_p_lower, -3000 * std::numbers::ln2 + std::log1p(3000 * std::numbers::ln2),
              1e-6);
  EXPECT_EQ(result.log_p_upper, 0);
}

TEST(QuantileTest, RefusesMalformedCounts) {
  EXPECT_THROW(quantile_test({0, 0, 0}, .5), std::domain_error);
  EXPECT_THROW(quantile_test({5, 4, 9}, .5), std::domain_error);
  EXPECT_THROW(quantile_test({5, 10, 9}, .5), std::domain_error);
  EXPECT_THROW(quantile_test({1, 1, 2}, 1), std::domain_error);
  const std::vector<double> bad{2, 1};
  const std::vector<double> nan{1, std::nan("")};
  EXPECT_THROW(count_around(bad, 1), std::domain_error);
  EXPECT_THROW(count_around(nan, 1), std::domain_error);
  EXPECT_THROW(quantile_interval({}, .5, .9), std::domain_error);
  EXPECT_THROW(quantile_compare(bad, bad, {}), std::domain_error);
  const std::vector<double> good{1, 2};
  EXPECT_THROW(quantile_compare(good, good, {.5, -1}), std::domain_error);
}

TEST(QuantileTest, BothSidesAreAtMostUniform) {
  const double truth = -std::log(.1);  // the .9 quantile of exp(1)
  for (const bool lower : {true, false}) {
    expect_calibrated({lower ? 331U : 332U, 20000, Shape::at_most_uniform}, [&](Philox& random) {
      const auto x = sorted(sample_of(80, [&] { return random.exponential(); }));
      const TestResult result = quantile_test(count_around(x, truth), .9);
      return lower ? result.log_p_lower : result.log_p_upper;
    });
  }
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

TEST(QuantileTest, ComparisonIsAtMostUniformForUnequalShapes) {
  // Medians of exp(1) and of a uniform law on (0, 2 ln 2).
  for (const bool lower : {true, false}) {
    expect_calibrated({lower ? 336U : 337U, 4000, Shape::at_most_uniform}, [&](Philox& random) {
      const auto x = sorted(sample_of(60, [&] { return random.exponential(); }));
      const auto y =
          sorted(sample_of(40, [&] { return 2 * std::numbers::ln2 * random.uniform(); }));
      const TestResult result = quantile_compare(x, y, {.5});
      return lower ? result.log_p_lower : result.log_p_upper;
    });
  }
}

TEST(QuantileTest, TwoPValuesAtTheMedianOfXAloneAreCaught) {
  // Reading the sample quantile of x as if it were known: the binomial p-value of y at it.
  expect_caught({338, 4000, Shape::at_most_uniform}, [](Philox& random) {
    const auto x = sorted(sample_of(61, [&] { return random.exponential(); }));
    const auto y = sorted(sample_of(61, [&] { return random.exponential(); }));
    return quantile_test(count_around(y, x[30]), .5).log_p_lower;
  });
}

// Misses of the .9 interval, Chernoff's bound at 2.5e-6.
TEST(QuantileTest, DifferenceIntervalsCover) {
  Philox random(339);
  int missed = 0;
  for (int i = 0; i < 400; ++i) {
    const auto x = sorted(sample_of(40, [&] { return 1 + random.normal(); }));
    const auto y = sorted(sample_of(40, [&] { return random.normal(); }));
    const Interval interval = quantile_difference_interval(x, y, .5, .9);
    missed += interval.low > 1 || interval.high < 1;
  }
  EXPECT_FALSE(tests::too_many(missed / 400.0, .1, 400)) << missed;
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
  EXPECT_THROW(sample_quantile_rank(0, 0.5), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
