#include "stats/laws/kolmogorov_smirnov.h"

#include "stats/tails/evidence.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

const ContinuousLaw exponential{[](double x) { return -std::expm1(-x); }};

TEST(KolmogorovSmirnov, TiesStepTogetherAndAreCounted) {
  const TwoSampleDistance distance =
      ks_distance(std::vector<double>{0, 0, 0, 1, 2}, std::vector<double>{0, 0, 0, 1, 3, 3});
  ASSERT_EQ(distance.ties.size(), 3U);
  EXPECT_EQ(distance.ties[1].before, 6U);
  EXPECT_EQ(distance.ties[1].size, 2U);
  EXPECT_EQ(distance.ties[2].before, 9U) << "beyond the end of the first sample";
  EXPECT_EQ(distance.most_frequent.value, 0);
  EXPECT_EQ(distance.most_frequent.count, 6U);
  const TwoSampleDistance shifted =
      ks_distance(std::vector<double>{0, 0, 0, 0}, std::vector<double>{0, 1, 1, 1});
  EXPECT_DOUBLE_EQ(shifted.distance(), .75);
}

// Values of low discrepancy to the power b, rounded down to so many levels.
std::vector<double> rounded_values(std::size_t count, double step, double power, double levels) {
  std::vector<double> values;
  for (std::size_t i = 1; i <= count; ++i) {
    const double u = std::fmod(static_cast<double>(i) * step, 1.0);
    values.push_back(std::floor(levels * std::pow(u, power)));
  }
  return sorted(values);
}

TEST(KolmogorovSmirnov, AgreesWithTheExactLawGivenTheTiesOfR) {
  for (const Row& row : read_table("ks_ties")) {
    const auto m = static_cast<std::size_t>(row["m"]);
    const auto n = static_cast<std::size_t>(row["n"]);
    const auto x = rounded_values(m, 0.6180339887498949, 1, row["levels"]);
    const auto y = rounded_values(n, 0.7548776662466927, row["power"], row["levels"]);
    const TwoSampleDistance distance = ks_distance(x, y);
    EXPECT_NEAR(distance.distance(), row["distance"], 1e-14);
    EXPECT_NEAR(std::exp(kolmogorov_smirnov(distance).log_p_upper) / row["p"], 1, 1e-9) << m;
  }
}

TEST(KolmogorovSmirnov, AZeroMarginIsThePlainOneSampleTest) {
  const OneSampleDistance distance = ks_distance(sorted(golden_x), exponential);
  EXPECT_EQ(ks_margin(distance, 0).log_p_upper, kolmogorov_smirnov(distance).log_p_upper);
}

TEST(KolmogorovSmirnov, MarginsMoveBothTailsMonotonically) {
  const OneSampleDistance one{.1, 500};
  const TwoSampleDistance two{.lattice = {50, 500, 500}};
  double last_upper = -1e300;
  double last_lower = 0;
  for (double delta = 0; delta < .9; delta += .05) {
    EXPECT_GE(ks_margin(one, delta).log_p_upper, last_upper);
    EXPECT_LE(ks_margin(one, delta).log_p_lower, last_lower);
    // Two empirical laws err twice: never more evidence than from one.
    EXPECT_GE(ks_margin(two, delta).log_p_upper, ks_margin(one, delta).log_p_upper - 1e-12);
    EXPECT_GE(ks_margin(two, delta).log_p_lower, ks_margin(one, delta).log_p_lower);
    last_upper = ks_margin(one, delta).log_p_upper;
    last_lower = ks_margin(one, delta).log_p_lower;
  }
  EXPECT_NEAR(ks_margin(one, .3).log_p_lower, -2 * 500 * .04, 1e-9);
}

Interval interval_of(const auto& distance, double estimate) {
  const auto at = [&](double theta) { return ks_margin(distance, std::min(theta, .999999)); };
  return distance_evidence({.at = at, .start = estimate, .largest = .999999, .beyond = 1})
      .interval(.98);
}

TEST(KolmogorovSmirnov, IntervalEndsAreJustRejected) {
  const OneSampleDistance one{.2, 500};
  const Interval interval = interval_of(one, .2);
  EXPECT_NEAR(ks_margin(one, interval.low).log_p_upper, std::log(.01), 1e-6);
  EXPECT_NEAR(ks_margin(one, interval.high).log_p_lower, std::log(.01), 1e-6);
  const TwoSampleDistance two{.lattice = {300, 1000, 1000}};
  const Interval wider = interval_of(two, two.distance());
  EXPECT_NEAR(ks_margin(two, wider.low).log_p_upper, std::log(.01), 1e-6);
  EXPECT_NEAR(ks_margin(two, wider.high).log_p_lower, std::log(.01), 1e-6);
  EXPECT_EQ(interval_of(OneSampleDistance{.01, 500}, .01).low, 0);
  EXPECT_EQ(interval_of(OneSampleDistance{.9, 5}, .9).high, 1);
}

// Zero with this probability, uniform otherwise.
std::vector<double> pixels(Philox& random, std::size_t n, double black) {
  return sorted(sample_of(n, [&] {
    const double u = random.uniform();
    return random.uniform() < black ? 0 : u;
  }));
}

TwoLawsTest of(const std::vector<double>& x, const std::vector<double>& y) {
  return two_part_ks(x, y, ks_distance(x, y));
}

TEST(TwoPartKs, WithoutAFrequentValueIsTheTestOfAllValues) {
  const std::vector<double> x{.1, .2, .9};
  const std::vector<double> y{.3, .4};
  const TwoLawsTest result = of(x, y);
  EXPECT_FALSE(result.common.has_value());
  EXPECT_EQ(result.result.log_p_upper, kolmogorov_smirnov(ks_distance(x, y)).log_p_upper);
}

// Two of the 35 orders of 3 and 4 values separate them.
TEST(TwoPartKs, ComparesTheOtherValuesApart) {
  const TwoLawsTest result = of({0, 0, 0, .7, .9, .95}, {0, 0, 0, .3, .4, .5, .6});
  ASSERT_TRUE(result.common.has_value());
  EXPECT_EQ(result.common->value, 0);
  EXPECT_FALSE(result.common->decides);
  EXPECT_NEAR(std::exp(result.result.log_p_upper), 2 * 2.0 / 35, 1e-14);
}

TEST(TwoPartKs, ComparesTheCountsOfTheFrequentValueByFishersExactTest) {
  // scipy: fisher_exact([[8, 2], [1, 5]], "greater")[1] = 0.024475524475524483; twice for two
  // sides, twice for two parts.
  std::vector<double> x(8, 0.0);
  x.insert(x.end(), {.3, .6});
  const TwoLawsTest result = of(x, {0, .1, .2, .4, .7, .8});
  ASSERT_TRUE(result.common.has_value());
  EXPECT_TRUE(result.common->decides);
  EXPECT_NEAR(result.common->difference, .8 - 1 / 6.0, 1e-15);
  EXPECT_NEAR(std::exp(result.result.log_p_upper), 4 * 0.024475524475524483, 1e-12);
}

TEST(TwoPartKs, OneValueAloneSaysNothing) {
  const std::vector<double> x(5, 0.0);
  EXPECT_EQ(of(x, x).result.log_p_upper, 0);
}

CALIBRATED(TwoPartKs, IsAtMostUniform, 372, 20000, Shape::at_most_uniform) {
  const auto x = pixels(random, 50, .3);
  return of(x, pixels(random, 70, .3)).result.log_p_upper;
}

// Every value comes again and again, and the most frequent is not known beforehand.
CALIBRATED(TwoPartKs, IsAtMostUniformForRoundedValues, 376, 20000, Shape::at_most_uniform) {
  const auto draw = [&](std::size_t n) {
    return sorted(sample_of(n, [&] { return std::round(2 * random.normal()); }));
  };
  const auto x = draw(60);
  return of(x, draw(45)).result.log_p_upper;
}

CAUGHT(TwoPartKs, TakingTheSmallerOfTwoPValuesForOneIsCaught, 373, 8000, Shape::at_most_uniform) {
  const auto x = pixels(random, 250, .5);
  const TwoLawsTest result = of(x, pixels(random, 270, .5));
  return result.result.log_p_upper - std::log(2);
}

// A path that is looked at inside runs of equal values too, as if these came in an order.
CAUGHT(TwoPartKs, AStatisticThatSeesTheOrderOfEqualValuesIsCaught, 377, 8000,
       Shape::at_most_uniform) {
  const auto x = pixels(random, 100, .5);
  const auto y = pixels(random, 100, .5);
  TwoSampleDistance distance = ks_distance(x, y);
  auto broken = y;
  for (double& value : broken) value = value == 0 ? -1e-9 : value;
  distance.lattice = ks_distance(x, sorted(broken)).lattice;
  return kolmogorov_smirnov(distance).log_p_upper;
}

// The share of 500 pairs of samples that the parts tell apart less that by the distance of all
// values, for alpha .01, n = 1000 each. Hoeffding at 1e-5 for R = 500: .11 each.
double found_more(std::uint32_t test_case, double black, double other_black, double power) {
  Philox random(test_case);
  int parts = 0, alone = 0;
  for (int i = 0; i < 500; ++i) {
    const auto x = pixels(random, 1000, black);
    auto y = pixels(random, 1000, other_black);
    for (double& value : y) value = std::pow(value, power);
    const TwoSampleDistance distance = ks_distance(x, y);
    parts += two_part_ks(x, y, distance).result.log_p_upper <= std::log(.01);
    alone += kolmogorov_smirnov(distance).log_p_upper <= std::log(.01);
  }
  std::cout << "  found " << parts / 500.0 << ", by the distance alone " << alone / 500.0 << "\n";
  return (parts - alone) / 500.0;
}

TEST(TwoPartKs, FindsWhatTheDistanceAloneMisses) {
  // Nine tenths are black in both. The rest is uniform in one and its square in the other. The rest
  // differs by .25 over 100 values, all values by .025 over 1000.
  EXPECT_GT(found_more(375, .9, .9, 2), .22);
  // The counts differ by 3.2 standard errors. At the lowest value the distance has .3 of its
  // largest standard error.
  EXPECT_GT(found_more(378, .1, .143, 1), .22);
}

}  // namespace
}  // namespace assay::stats
