#include "stats/laws/anderson_darling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "tests/stats/expect_calibrated.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

using tests::expect_calibrated;
using tests::expect_caught;
using tests::Experiment;
using tests::Philox;
using tests::Row;
using tests::sample_of;
using tests::Shape;
using tests::sorted;

double identity(double u) { return u; }

// By the law's function `cdf` at the sorted values.
template <class Cdf>
TestResult by(const std::vector<double>& sorted, const Cdf& cdf, double error = 0) {
  std::vector<double> at;
  for (const double value : sorted) at.push_back(cdf(value));
  return anderson_darling(Probabilities{at}, error);
}

TEST(AndersonDarling, LimitLawAgreesWithTheSeriesOfTheOtherTail) {
  constexpr std::uint64_t endless = 1'000'000'000'000'000;
  for (const Row& row : tests::read_table("anderson_darling")) {
    const double computed = log_anderson_darling_upper(row["x"], endless);
    EXPECT_NEAR(computed, row["log_upper"], 1e-12 * (1 - row["log_upper"])) << row["x"];
  }
}

TEST(AndersonDarling, GoldenStatistic) {
  const auto exponential = [](double x) { return -std::expm1(-x); };
  EXPECT_NEAR(by(sorted(tests::golden_x), exponential).statistic, .174383413363932, 1e-13);
}

TEST(AndersonDarling, TailsStayFiniteAndFall) {
  double before = 0;
  for (const double x : {0.01, .1, 1.0, 10.0, 100.0, 1e4, 1e300}) {
    const double log_p = log_anderson_darling_upper(x, 10);
    EXPECT_LE(log_p, before);
    EXPECT_TRUE(std::isfinite(log_p));
    before = log_p;
  }
  // Either side of the change to Laplace's formula.
  const std::uint64_t n = 1'000'000'000'000;
  EXPECT_NEAR(log_anderson_darling_upper(999999, n) - log_anderson_darling_upper(1000001, n), 2,
              1e-5);
}

TEST(AndersonDarling, AValueThatTheLawExcludesRejects) {
  const std::vector<double> values{-1, .2, .3, .5, .7};
  const auto clipped = [](double u) { return std::max(0.0, u); };
  EXPECT_LT(by(values, clipped).log_p_upper, -1e300);
}

TEST(AndersonDarling, RefusesWhatItsLawDoesNotCover) {
  const std::vector<double> four{.1, .2, .3, .4};
  const std::vector<double> good{.1, .2, .3, .4, .5};
  EXPECT_THROW(by(four, identity), std::domain_error);
  EXPECT_THROW(by(good, [](double) { return 2.0; }), std::domain_error);
  EXPECT_THROW(log_anderson_darling_upper(std::nan(""), 10), std::domain_error);
}

TEST(AndersonDarling, OfOneSampleIsUniform) {
  std::uint32_t test_case = 361;
  for (const std::size_t n : {std::size_t{5}, std::size_t{20}, std::size_t{200}}) {
    expect_calibrated({test_case++, n > 100 ? 10000UL : 40000UL}, [&](Philox& random) {
      const auto u = sorted(sample_of(n, [&] { return random.uniform(); }));
      return by(u, identity).log_p_upper;
    });
  }
}

// The law is given .01 off, at n = 100 a fifth of its own spread.
TEST(AndersonDarling, OfALawKnownUpToAnErrorIsAtMostUniform) {
  const auto off = [](double x) { return std::clamp(x + .01, 0.0, 1.0); };
  expect_calibrated({369, 20000, Shape::at_most_uniform}, [&](Philox& random) {
    const auto u = sorted(sample_of(100, [&] { return random.uniform(); }));
    return by(u, off, .01).log_p_upper;
  });
}

// A value below the given law's range, within its error of it, excludes nothing. Without the error
// it excludes the law.
TEST(AndersonDarling, TakesTheLeastStatisticOfAllLawsWithinTheError) {
  Philox random(370);
  const auto u = sorted(sample_of(200, [&] { return random.uniform(); }));
  double before = by(u, identity).statistic;
  for (const double error : {1e-4, 1e-3, 1e-2, .1}) {
    const double now = by(u, identity, error).statistic;
    EXPECT_LT(now, before) << error;
    before = now;
  }
  // Every u_i is at its bottom: the entropy of the bottoms, n terms.
  double least = -200;
  for (int i = 0; i < 200; ++i) {
    const double bottom = (i + .5) / 200;
    least -= ((2 * i + 1) * std::log(bottom) + (399 - 2 * i) * std::log1p(-bottom)) / 200;
  }
  EXPECT_NEAR(by(u, identity, .5).statistic, least, 1e-9);
  const auto shifted = [](double x) { return std::clamp(2 * x - .5, 0.0, 1.0); };
  EXPECT_LT(by(u, shifted).log_p_upper, -1e300);
  EXPECT_GT(by(u, shifted, .6).log_p_upper, -1e3);
  EXPECT_THROW(by(u, identity, -1e-9), std::domain_error);
}

TEST(AndersonDarling, WeightsInTheWrongOrderAreCaught) {
  expect_caught({367, 10000}, [](Philox& random) {
    const auto u = sorted(sample_of(20, [&] { return random.uniform(); }));
    double sum = 0;
    for (std::size_t i = 0; i < 20; ++i) {
      sum += static_cast<double>(2 * i + 1) * (std::log(u[i]) + std::log1p(-u[i]));
    }
    return log_anderson_darling_upper(std::max(.02, -20 - sum / 20), 20);
  });
}

TEST(AndersonDarling, AParameterFittedFromTheSampleIsCaught) {
  expect_caught({368, 10000}, [](Philox& random) {
    const auto x = sorted(sample_of(50, [&] { return random.exponential(); }));
    const double mean = tests::moments_of(x).mean;
    return by(x, [&](double v) { return -std::expm1(-v / mean); }).log_p_upper;
  });
}

}  // namespace
}  // namespace assay::stats
