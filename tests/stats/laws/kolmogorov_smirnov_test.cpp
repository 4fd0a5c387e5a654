#include "stats/laws/kolmogorov_smirnov.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

const ContinuousLaw exponential{[](double x) { return -std::expm1(-x); }};

TEST(KolmogorovSmirnov, AnAtomNeedsItsLeftLimit) {
  // Half the mass at 0, the rest uniform on (0, 1): the sample is as it should be.
  const std::vector<double> values{0, 0, .25, .75};
  const auto cdf = [](double x) { return x < 0 ? 0 : std::min(1.0, .5 + x / 2); };
  const auto before = [](double x) { return x <= 0 ? 0 : std::min(1.0, .5 + x / 2); };
  EXPECT_DOUBLE_EQ(ks_distance(values, {cdf, before}).distance, .125);
  EXPECT_DOUBLE_EQ(ks_distance(values, {cdf}).distance, .5);
}

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
  EXPECT_EQ(shifted.location, 0);
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
  const OneSampleDistance one{.1, 500, 0};
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

TEST(KolmogorovSmirnov, IntervalEndsAreJustRejected) {
  const OneSampleDistance one{.2, 500, 0};
  const Interval interval = ks_interval(one, .98);
  EXPECT_NEAR(ks_margin(one, interval.low).log_p_upper, std::log(.01), 1e-6);
  EXPECT_NEAR(ks_margin(one, interval.high).log_p_lower, std::log(.01), 1e-6);
  const TwoSampleDistance two{.lattice = {300, 1000, 1000}};
  const Interval wider = ks_interval(two, .98);
  EXPECT_NEAR(ks_margin(two, wider.low).log_p_upper, std::log(.01), 1e-6);
  EXPECT_NEAR(ks_margin(two, wider.high).log_p_lower, std::log(.01), 1e-6);
  EXPECT_EQ(ks_interval(OneSampleDistance{.01, 500, 0}, .98).low, 0);
  EXPECT_EQ(ks_interval(OneSampleDistance{.9, 5, 0}, .98).high, 1);
}

TEST(KolmogorovSmirnov, TakesProbabilitiesInPlaceOfALaw) {
  const std::vector<double> x = sorted(golden_x);
  const std::vector<double> at = probabilities(x, exponential);
  EXPECT_EQ(ks_distance(x, Probabilities{at}).distance, ks_distance(x, exponential).distance);
  EXPECT_EQ(ks_distance(x, Probabilities{at}).location, ks_distance(x, exponential).location);
}

}  // namespace
}  // namespace assay::stats
