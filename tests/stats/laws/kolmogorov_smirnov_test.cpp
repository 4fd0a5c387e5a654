#include "stats/laws/kolmogorov_smirnov.h"

#include "tests/prelude.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

const ContinuousLaw exponential{[](double x) { return -std::expm1(-x); }};

TEST(KolmogorovSmirnov, OneSampleGoldenValuesToThePrintedDigits) {
  const OneSampleDistance distance = ks_distance(sorted(golden_x), exponential);
  EXPECT_NEAR(distance.distance, .12303325642225293, 1e-15);
  const TestResult result = kolmogorov_smirnov(distance);
  EXPECT_NEAR(std::exp(result.log_p_upper), .993117303692647, 1e-10);
  EXPECT_EQ(result.log_p_lower, 0);
}

TEST(KolmogorovSmirnov, TwoSampleGoldenValuesToThePrintedDigits) {
  const TwoSampleDistance distance = ks_distance(sorted(golden_x), sorted(golden_y));
  EXPECT_DOUBLE_EQ(distance.distance(), .4);
  EXPECT_TRUE(distance.ties.empty());
  EXPECT_NEAR(std::exp(kolmogorov_smirnov(distance).log_p_upper), .433412176059232, 1e-14);
}

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

// R 4.2: psmirnov(ks.test(x, y)$statistic, sizes = c(m, n), z = c(x, y), lower.tail = FALSE).
TEST(KolmogorovSmirnov, AgreesWithTheExactLawGivenTheTiesOfR) {
  struct Case {
    std::size_t m;
    std::size_t n;
    double power;
    double levels;
    double distance;
    double p;
  };
  for (const Case& c : {Case{10, 14, 2, 3, 0.314285714285714, 0.211233005788115},
                        Case{40, 40, 1.5, 5, 0.15, 0.478712637285825},
                        Case{100, 64, 1.3, 4, 0.115, 0.296744097754161},
                        Case{200, 300, 1.2, 50, 0.075, 0.401421144677214},
                        Case{300, 500, 1.25, 1000, 0.0893333333333333, 0.0933294030372724},
                        Case{30, 17, 3, 2, 0.356862745098039, 0.0291468755694492}}) {
    const auto x = rounded_values(c.m, 0.6180339887498949, 1, c.levels);
    const auto y = rounded_values(c.n, 0.7548776662466927, c.power, c.levels);
    const TwoSampleDistance distance = ks_distance(x, y);
    EXPECT_NEAR(distance.distance(), c.distance, 1e-14);
    EXPECT_NEAR(std::exp(kolmogorov_smirnov(distance).log_p_upper) / c.p, 1, 1e-9) << c.m;
  }
}

TEST(KolmogorovSmirnov, DisjointSamplesAreAtDistanceOne) {
  const TwoSampleDistance distance =
      ks_distance(std::vector<double>{1, 2}, std::vector<double>{5, 6, 7});
  EXPECT_DOUBLE_EQ(distance.distance(), 1);
  EXPECT_NEAR(std::exp(kolmogorov_smirnov(distance).log_p_upper), 2.0 / 10, 1e-14);
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
  EXPECT_THROW(ks_distance(x, Probabilities{std::span(at).first(1)}), std::domain_error);
  const std::vector<double> beyond(x.size(), 1.5);
  EXPECT_THROW(ks_distance(x, Probabilities{beyond}), std::domain_error);
}

TEST(KolmogorovSmirnov, BadSamplesThrow) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> good{1, 2};
  for (const std::vector<double>& bad :
       {std::vector<double>{}, std::vector<double>{2, 1}, std::vector<double>{1, nan},
        std::vector<double>{nan}, std::vector<double>{1, infinity}}) {
    EXPECT_THROW(ks_distance(bad, exponential), std::domain_error);
    EXPECT_THROW(ks_distance(bad, good), std::domain_error);
    EXPECT_THROW(ks_distance(good, bad), std::domain_error);
  }
  EXPECT_THROW(ks_distance(good, {[](double x) { return x; }}), std::domain_error);
  EXPECT_THROW(ks_margin(OneSampleDistance{.1, 5, 0}, 1), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
