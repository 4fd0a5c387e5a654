#include "stats/means/binomial.h"

#include "stats/tails/special.h"
#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(Binomial, TailsIncludeTheObservedCount) {
  const TestResult result = binomial({1, 2}, .5);
  EXPECT_NEAR(std::exp(result.log_p_lower), .75, 1e-15);
  EXPECT_NEAR(std::exp(result.log_p_upper), .75, 1e-15);
  EXPECT_EQ(log_p_two_sided(result), 0);
}

TEST(Binomial, ClopperPearsonEndsAreJustRejected) {
  for (const std::uint64_t k : {1ULL, 7ULL, 59ULL}) {
    const Interval interval = clopper_pearson({k, 60}, .99);
    EXPECT_NEAR(std::exp(binomial({k, 60}, interval.low).log_p_upper), .005, 1e-11);
    EXPECT_NEAR(std::exp(binomial({k, 60}, interval.high).log_p_lower), .005, 1e-11);
  }
  EXPECT_EQ(clopper_pearson({0, 60}, .99).low, 0);
  EXPECT_EQ(clopper_pearson({60, 60}, .99).high, 1);
  EXPECT_NEAR(clopper_pearson({0, 60}, .99).high, 1 - std::pow(.005, 1 / 60.0), 1e-12);
}

TEST(Binomial, CertainAndImpossibleNullProbabilities) {
  EXPECT_TRUE(std::isfinite(binomial({3, 10}, 0).log_p_upper));
  EXPECT_LT(binomial({3, 10}, 0).log_p_upper, -1e300);
  EXPECT_EQ(binomial({0, 10}, 0).log_p_upper, 0);
  EXPECT_EQ(binomial({10, 10}, 1).log_p_lower, 0);
}

constexpr Range unit_range{0, 1};

TwoValued hits(double successes, double trials, Range range = unit_range) {
  return {range, {static_cast<std::uint64_t>(successes), static_cast<std::uint64_t>(trials)}};
}

TEST(TwoValued, TheCountIsRecoveredFromMoments) {
  std::vector<double> values(997, -2.5);
  for (std::size_t i = 0; i < 41; ++i) values[i * 20] = 7.1;
  const TwoValued x = two_valued(moments_of(values), {-2.5, 7.1});
  EXPECT_EQ(x.high.successes, 41U);
  EXPECT_EQ(x.high.trials, 997U);
  EXPECT_EQ(two_valued(moments_of(std::vector<double>(9, 7.1)), {-2.5, 7.1}).high.successes, 9U);
}

TEST(TwoValuedMean, IsTheExactBinomialTest) {
  const TestResult result = two_valued_mean(hits(3, 50, {-1, 3}), -.72);
  const TestResult direct = binomial({3, 50}, .07);
  EXPECT_NEAR(result.log_p_lower, direct.log_p_lower, 1e-12);
  EXPECT_NEAR(result.log_p_upper, direct.log_p_upper, 1e-12);
}

// P(a method's p <= level) at one point of the null, by summing over every pair of counts.
template <class LogP>
double exact_level(Trials x, Trials y, double level, const LogP& log_p) {
  double total = 0;
  for (std::uint64_t i = 0; i <= x.trials; ++i) {
    for (std::uint64_t j = 0; j <= y.trials; ++j) {
      if (log_p(hits(static_cast<double>(i), static_cast<double>(x.trials)),
                hits(static_cast<double>(j), static_cast<double>(y.trials))) > std::log(level)) {
        continue;
      }
      total +=
          binomial_mass(i, x.trials, x.probability) * binomial_mass(j, y.trials, y.probability);
    }
  }
  return total;
}

TEST(TwoValuedContrast, AgreesWithFishersStatisticMaximisedOverAGrid) {
  for (const Row& row : tests::read_table("two_valued")) {
    const double lower = row["log_lower"];
    const Contrast contrast{row["slope"], row["start"]};
    const TestResult result =
        two_valued_contrast(hits(row["x"], row["n"]), hits(row["y"], row["m"]), contrast);
    EXPECT_NEAR(result.log_p_lower, lower, 1e-7 * (1 - lower)) << row["x"] << " " << row["y"];
    // The mirror image: misses for hits, signs changed.
    const TwoValued x = hits(row["n"] - row["x"], row["n"], {-1, 0});
    const TwoValued y = hits(row["m"] - row["y"], row["m"], {-1, 0});
    const TestResult mirror = two_valued_contrast(x, y, {row["slope"], -row["start"]});
    EXPECT_NEAR(mirror.log_p_upper, lower, 1e-7 * (1 - lower));
  }
}

TEST(TwoValuedContrast, TheLevelIsKeptAtEveryPointOfTheNull) {
  double largest = 0;
  for (const double d : {0.0, .1}) {
    const auto lower = [&](const TwoValued& x, const TwoValued& y) {
      return two_valued_contrast(x, y, {1, d}).log_p_lower;
    };
    for (const double q : {.02, .1, .3, .5, .7, .88}) {
      for (const double level : {.05, .01}) {
        const double actual = exact_level({20, q + d}, {14, q}, level, lower);
        EXPECT_LE(actual, level) << d << " " << q;
        largest = std::max(largest, actual / level);
      }
    }
  }
  EXPECT_GT(largest, .2);  // conservative, but a test
}

TEST(TwoValuedContrast, TheProductTakenForAProbabilityIsNoticed) {
  const auto product = [](const TwoValued& x, const TwoValued& y) {
    double best = -1e9;
    for (double q = .01; q < 1; q += .02) {
      best = std::max(best, binomial(x.high, q).log_p_lower + binomial(y.high, q).log_p_upper);
    }
    return best;
  };
  EXPECT_GT(exact_level({25, .5}, {18, .5}, .05, product), .05);
}

TEST(TwoValuedContrast, IntervalEndsAreJustRejected) {
  const TwoValued x = hits(30, 200, {-1, 1});
  const TwoValued y = hits(55, 220, {0, 3});
  const Interval interval = two_valued_difference_interval(x, y, .98);
  EXPECT_NEAR(two_valued_contrast(x, y, {1, interval.low}).log_p_upper, std::log(.01), 1e-6);
  EXPECT_NEAR(two_valued_contrast(x, y, {1, interval.high}).log_p_lower, std::log(.01), 1e-6);
  const Interval none = two_valued_difference_interval(hits(0, 3), hits(3, 3), .999);
  EXPECT_EQ(none.low, -1);
}

TEST(TwoValuedContrast, CostsLittleWhereTheNormalApproximationHolds) {
  // At z = 4 of the pooled normal test and equal sizes p is within a factor three of its tail.
  const TwoValued x = hits(4717, 10000);
  const TwoValued y = hits(5000, 10000);
  const double z = .0283 / std::sqrt(2 * .48585 * .51415 / 10000);
  const double log_p = two_valued_contrast(x, y, {}).log_p_lower;
  EXPECT_NEAR(log_p, normal_tails(-z).lower, std::log(3));
}

// E x + E y = 1 is E x - E (1 - y) = 0.
TEST(TwoValuedContrast, OfANegativeScaleIsThatOfTheMirroredSample) {
  const TestResult sum = two_valued_contrast(hits(30, 100), hits(45, 90), {-1, 1});
  const TestResult difference = two_valued_contrast(hits(30, 100), hits(45, 90), {1, 0});
  EXPECT_NEAR(sum.statistic, difference.statistic, 1e-15);
  EXPECT_DOUBLE_EQ(sum.log_p_lower, difference.log_p_lower);
  EXPECT_DOUBLE_EQ(sum.log_p_upper, difference.log_p_upper);
}

TEST(TwoValuedContrast, OfScaleZeroIsTheExactTestOfOneMean) {
  const TestResult one = two_valued_contrast(hits(30, 100), hits(45, 90), {0, .4});
  EXPECT_EQ(one.log_p_lower, two_valued_mean(hits(30, 100), .4).log_p_lower);
}

TEST(TwoValued, AnImpossibleNullIsRejectedOutright) {
  const TwoValued x = hits(3, 10);
  for (const TestResult& high : {two_valued_mean(x, 1.2), two_valued_contrast(x, x, {1, 1.5})}) {
    EXPECT_EQ(high.log_p_lower, special::lowest_log());
    EXPECT_EQ(high.log_p_upper, 0);
  }
  for (const TestResult& low : {two_valued_mean(x, -.2), two_valued_contrast(x, x, {1, -1.5})}) {
    EXPECT_EQ(low.log_p_upper, special::lowest_log());
    EXPECT_EQ(low.log_p_lower, 0);
  }
}

}  // namespace
}  // namespace assay::stats
