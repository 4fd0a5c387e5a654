#include "stats/variances/slope.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// The cases of make_ratios.py.
SlopeData known(int index) {
  switch (index) {
    case 0:
      return {{{8, .1281, .004}, {16, .0613, .004}, {32, .0322, .004}, {64, .0157, .004}}, .002};
    case 1:
      return {{{8, -.125, .01}, {16, -.066, .008}, {32, -.028, .006}, {64, -.012, .005}}, .003};
    case 2:
      return {{{8, .125, .05}, {16, .066, .05}, {32, .028, .05}, {64, .012, .05}}, .01};
    case 3:
      return {{{8, .125, .01}, {16, .01, .01}, {32, 0, .01}, {64, .01, .01}}};
    case 4:
      return {{{1, 1, .02}, {10, 3.1, .05}, {100, 10.2, .2}}, .1};
    default:
      return {{{1, 1, .1}, {2, -1, .1}, {4, 1, .1}, {8, -1, .1}, {16, 1, .1}}};
  }
}

SlopeData logarithms(SlopeData data) {
  for (SlopePoint& point : data.points) {
    point.standard_error /= point.estimate;
    point.estimate = std::log(point.estimate);
  }
  data.scale = SlopeScale::logarithms;
  return data;
}

double log_p_of(const SlopeData& data, double slope) {
  const double degrees = static_cast<double>(data.points.size()) - 1;
  return chi_square_tails(slope_test(data, slope).statistic, degrees).upper;
}

TEST(Slope, AgreesWithGeneralisedLeastSquaresOnTheFullMatrix) {
  for (const Row& row : tests::read_table("slope")) {
    SCOPED_TRACE(row.text("case") + " " + row.text("logs"));
    SlopeData data = known(static_cast<int>(row["case"]));
    if (row["logs"] == 1) data = logarithms(data);
    EXPECT_NEAR(slope_test(data, row["null"]).statistic / row["misfit"], 1, 1e-9);
    EXPECT_NEAR(std::exp(log_p_of(data, row["null"])) / row["p"], 1, 1e-7);
    EXPECT_NEAR(slope_power(data, row["null"], .01), row["power"], 1e-7);
    const Interval set = slope_set(data, .99);
    if (row.text("low") == "nan") {
      EXPECT_TRUE(std::isnan(set.low) && std::isnan(set.high));
      continue;
    }
    expect_near_or_infinite(set.low, row["low"], 1e-9);
    expect_near_or_infinite(set.high, row["high"], 1e-9);
  }
}

TEST(Slope, TheOrderOfThePointsAndTheUnitOfSizeDoNotMatter) {
  const SlopeData data = known(0);
  SlopeData other = data;
  std::swap(other.points[0], other.points[3]);
  for (SlopePoint& point : other.points) point.size *= 1000;
  EXPECT_NEAR(log_p_of(other, -1.1), log_p_of(data, -1.1), 1e-9);
  EXPECT_NEAR(slope_set(other, .9).low, slope_set(data, .9).low, 1e-9);
}

TEST(Slope, OneSidedPValuesAreTheLargestOverTheirHalfLine) {
  const SlopeData data = known(0);
  const double best = slope_estimate(data).slope;
  EXPECT_NEAR(best, -1, .05);
  const TestResult steep = slope_test(data, best - .3);
  EXPECT_EQ(steep.log_p_upper, log_p_of(data, best - .3));  // "<= that" is rejected
  EXPECT_GT(steep.log_p_lower, std::log(.5));
  const TestResult flat = slope_test(data, best + .3);
  EXPECT_EQ(flat.log_p_lower, log_p_of(data, best + .3));
  EXPECT_GT(flat.log_p_upper, std::log(.5));
}

TEST(Slope, NoiseAloneLeavesEverySlopePossible) {
  const Interval set = slope_set({{{8, .1, 1}, {16, -.2, 1}, {32, .3, 1}}}, .99);
  EXPECT_TRUE(std::isinf(set.low) && std::isinf(set.high));
}

TEST(Slope, TheSetIsEmptyWhereEvenTheBestSlopeIsRejected) {
  for (const int index : {0, 1, 3, 4}) {
    const double p = std::exp(slope_estimate(known(index)).log_p_best);
    EXPECT_FALSE(std::isnan(slope_set(known(index), 1 - p * .999).low)) << index;
    EXPECT_TRUE(std::isnan(slope_set(known(index), 1 - p * 1.001).low)) << index;
  }
}

TEST(Slope, TwoPointsGiveTheRatioOfTwoNumbers) {
  // (b1 M1^-s - b2 M2^-s)^2 over its variance, at s = -1: (.2 * 1 - .05 * 4)^2 = 0.
  const SlopeData data{{{1, .2, .01}, {4, .05, .01}}};
  EXPECT_NEAR(slope_test(data, -1).statistic, 0, 1e-20);
  EXPECT_NEAR(slope_estimate(data).slope, -1, 1e-6);
  const double contrast = .2 - .05 * 2;  // s = -1/2
  const double variance = 1e-4 + 4 * 1e-4;
  EXPECT_NEAR(slope_test(data, -.5).statistic, contrast * contrast / variance, 1e-9);
}

TEST(Slope, APowerLawKnownToManyDigitsHasANarrowInterval) {
  SlopeData data;
  for (const double size : {8.0, 16.0, 1000.0, 1001.0}) {
    data.points.push_back({size, std::pow(size, -1.7), 1e-8 * std::pow(size, -1.7)});
  }
  const Interval set = slope_set(data, .99);
  EXPECT_LT(set.low, -1.7);
  EXPECT_GT(set.high, -1.7);
  EXPECT_LT(set.high - set.low, 1e-7);
}

// Biases M^slope at four sizes, with this error each and one of the reference that all share.
SlopeData biases(Philox& random, double slope, double error, double reference) {
  const double common = reference * random.normal();
  SlopeData data{.points = {}, .reference_error = reference};
  for (const double size : {8.0, 16.0, 32.0, 64.0}) {
    const double noise = error * random.normal() + common;
    data.points.push_back({size, std::pow(size, slope) + noise, error});
  }
  return data;
}

// The bias at M = 64 is two standard errors.
SlopeData inverse_bias(Philox& random) { return biases(random, -1, .5 / 64, .25 / 64); }

// At most .01 of the samples leave no slope at .01. Of 4000 more than 75 have a probability below
// 1e-6.
TEST(Slope, OnAPowerLawTheSetIsSeldomEmpty) {
  Philox random(1719);
  int empty = 0;
  for (int run = 0; run < 4000; ++run) {
    empty += slope_estimate(biases(random, -1, .004, 0)).log_p_best <= std::log(.01);
  }
  EXPECT_LE(empty, 75);
}

CALIBRATED(Slope, OfAnInverseBiasIsCalibratedWhereTheLastBiasIsTwoStandardErrors, 321, 10000) {
  return log_p_of(inverse_bias(random), -1);
}

TAILS_CALIBRATED(Slope, OneSidedPValuesAreAtMostUniformAtTheTruth, 322, 2000,
                 Shape::at_most_uniform) {
  return slope_test(inverse_bias(random), -1);
}

CALIBRATED(Slope, OfLogarithmsIsCalibrated, 325, 20000) {
  SlopeData data{.points = {}, .scale = SlopeScale::logarithms};
  for (const double size : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    data.points.push_back({size, 3 - .5 * std::log(size) + .1 * random.normal(), .1});
  }
  return log_p_of(data, -.5);
}

CAUGHT(Slope, ACommonErrorOfTheReferenceTakenForIndependentErrorsIsCaught, 327, 20000) {
  SlopeData data = inverse_bias(random);
  for (SlopePoint& point : data.points) {
    point.standard_error = std::hypot(point.standard_error, data.reference_error);
  }
  data.reference_error = 0;
  return log_p_of(data, -1);
}

CAUGHT(Slope, OneDegreeOfFreedomTooManyIsCaught, 328, 10000) {
  return chi_square_tails(slope_test(inverse_bias(random), -1).statistic, 4).upper;
}

// |rate - power| <= sqrt(ln(2e5) / (2 R)): .0391 at R = 4000, false alarm 1e-5.
TEST(Slope, APlannedFactorFindsTheSlopeItWasPlannedFor) {
  Philox random(329);
  SlopeData expected = biases(random, -.5, 0, 0);
  for (SlopePoint& point : expected.points) point.standard_error = .1;
  expected.reference_error = .01;
  const double factor = slope_sample_factor(expected, -.7, {.01, .2, false}).value();
  int found = 0;
  for (int i = 0; i < 4000; ++i) {
    const SlopeData data = biases(random, -.5, .1 / std::sqrt(factor), .01);
    found += log_p_of(data, -.7) <= std::log(.01);
  }
  EXPECT_NEAR(found / 4000.0, .8, .0391);
}

TEST(Slope, NoSampleOutweighsAnErrorOfTheReferenceOnTwoPoints) {
  const SlopeData expected{{{1, .2, .01}, {4, .05, .01}}, 1};
  EXPECT_FALSE(slope_sample_factor(expected, -.9, {.01, .2, false}).has_value());
}

}  // namespace
}  // namespace assay::stats
