#include "stats/means/bounded_mean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "tests/stats/calibration.h"
#include "tests/stats/laws.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

using tests::draw_moments;
using tests::draw_values;
using tests::Law;
using tests::moments_of;
using tests::Philox;
using tests::Row;
using tests::Shape;
namespace laws = tests::laws;

constexpr Range unit{0, 1};

// make_means.py, fractions.
std::vector<double> fractions(int k, int n) {
  std::vector<double> values;
  for (int i = 1; i <= n; ++i) {
    const double u = i * ((std::sqrt(5.0) - 1) / 2);
    values.push_back(std::pow(u - std::floor(u), k));
  }
  return values;
}

std::vector<double> rescaled(std::vector<double> values, Range range) {
  for (double& value : values) value = range.low + (range.high - range.low) * value;
  return values;
}

void expect_log_p(double computed, double expected) {
  EXPECT_NEAR(computed, expected, 1e-9 * (1 + std::abs(expected)));
}

TEST(BoundedMean, AgreesWithBoundsInvertedByRootFinding) {
  constexpr Range range{-2, 3};
  for (const Row& row : tests::read_table("bounded_mean")) {
    const auto x = fractions(static_cast<int>(row["k"]), static_cast<int>(row["n"]));
    const double end = range.low + row["part"] * (range.high - range.low);
    const Moments moments = moments_of(rescaled(x, {range.low, end}));
    const TestResult result = bounded_mean(moments, range, row["null"]);
    expect_log_p(result.log_p_lower, row["log_lower"]);
    expect_log_p(result.log_p_upper, row["log_upper"]);
    EXPECT_EQ(result.exactness, Exactness::exact);
    EXPECT_EQ(result.distribution.family, "bound");
  }
}

// A mean of 1e-12 of the range keeps its digits on both sides: p is smooth there.
TEST(BoundedMean, OfATinyPartOfTheRangeKeepsItsDigits) {
  const Moments x = moments_of(fractions(1, 4000));
  const Range wide{0, 1e12};
  double before = 0;
  for (const double step : {.1, .2, .3}) {
    const double now = bounded_mean(x, wide, x.mean * (1 - step)).log_p_upper;
    EXPECT_LT(now, before) << step;
    before = now;
  }
  const double at = bounded_mean(x, wide, .8 * x.mean).log_p_upper;
  const double next = bounded_mean(x, wide, .8 * x.mean * (1 + 1e-9)).log_p_upper;
  EXPECT_LT(std::abs(next - at), 1e-5);
  EXPECT_GT(next, at);
}

TEST(BoundedMean, PFallsAsTheNullMovesAway) {
  const Moments x = moments_of(fractions(3, 500));
  double above = 0;
  double below = 0;
  for (int step = 1; step < 200; ++step) {
    const double reach = step / 200.0;
    const double higher = bounded_mean(x, unit, x.mean + (1 - x.mean) * reach).log_p_lower;
    const double lower = bounded_mean(x, unit, x.mean * (1 - reach)).log_p_upper;
    EXPECT_LE(higher, above) << reach;
    EXPECT_LE(lower, below) << reach;
    above = higher;
    below = lower;
  }
}

TEST(BoundedMean, AConstantSampleRejectsAsClopperAndPearsonAtAThirdOfTheError) {
  const Moments zeros = moments_of(std::vector<double>(1000, 0.0));
  EXPECT_EQ(bounded_mean(zeros, unit, 1e-9).log_p_upper, 0);
  EXPECT_NEAR(bounded_mean(zeros, unit, 1 - std::pow(.01 / 3, 1e-3)).log_p_lower, std::log(.01),
              1e-9);
}

TEST(BoundedMean, AnImpossibleMeanIsRejectedOutright) {
  const Moments x = moments_of(fractions(1, 20));
  EXPECT_EQ(bounded_mean(x, unit, 1.1).log_p_lower, std::numeric_limits<double>::lowest());
  EXPECT_EQ(bounded_mean(x, unit, 1.1).log_p_upper, 0);
  EXPECT_EQ(bounded_mean(x, unit, -.1).log_p_upper, std::numeric_limits<double>::lowest());
  EXPECT_EQ(bounded_mean(x, unit, -.1).log_p_lower, 0);
}

TEST(BoundedMean, BadArgumentsAreNamed) {
  const Moments x = moments_of(fractions(1, 20));
  EXPECT_THROW(bounded_mean(x, {0, .5}, .3), std::domain_error);
  EXPECT_THROW(bounded_mean(x, {.5, 1}, .3), std::domain_error);
  EXPECT_THROW(bounded_mean(x, {1, 0}, .3), std::domain_error);
  EXPECT_THROW(bounded_mean(x, {0, INFINITY}, .3), std::domain_error);
  EXPECT_THROW(bounded_mean(x, unit, NAN), std::domain_error);
  EXPECT_THROW(bounded_mean(moments_of(std::vector<double>{.5}), unit, .3), std::domain_error);
}

// ---- Under the null, P(p <= a) <= a. False alarms 1e-5 each; seed 1, streams 251 and on.

const std::vector<Law> bounded_laws{laws::bernoulli, laws::uniform, laws::zero_inflated_uniform};

template <class Draw>
bool calibrated(std::uint32_t test_case, const char* name, const Draw& draw,
                std::size_t repetitions = 5000) {
  const auto calibration = tests::calibrate({test_case, repetitions, Shape::at_most_uniform}, draw);
  std::printf("  %s: %s\n", name, calibration.text().c_str());
  return calibration.ok;
}

TEST(BoundedMean, KeepsItsLevelOnEveryBoundedLaw) {
  std::uint32_t test_case = 251;
  for (const Law& law : bounded_laws) {
    for (const std::size_t n : {10UL, 300UL}) {
      EXPECT_TRUE(calibrated(test_case++, law.name, [&](Philox& random) {
        return log_p_two_sided(bounded_mean(draw_moments(law, n, random), unit, law.mean));
      }));
    }
  }
}

// Values fill a hundredth of the range, at its lower and at its upper end. The bets decide on that
// side.
TEST(BoundedMean, KeepsItsLevelInAWideRange) {
  std::uint32_t test_case = 261;
  for (const Law& law : bounded_laws) {
    EXPECT_TRUE(calibrated(test_case++, law.name, [&](Philox& random) {
      return bounded_mean(draw_moments(law, 300, random), {0, 100}, law.mean).log_p_upper;
    }));
    EXPECT_TRUE(calibrated(test_case++, law.name, [&](Philox& random) {
      auto values = draw_values(law, 300, random);
      for (double& value : values) value = 100 - value;
      return bounded_mean(moments_of(values), {0, 100}, 100 - law.mean).log_p_lower;
    }));
  }
}

// ---- Mutants

TEST(BoundedMean, TheVarianceBoundWithoutItsLinearTermIsNoticed) {
  EXPECT_FALSE(calibrated(281, "mutant", [](Philox& random) {
    const Moments x = draw_moments(laws::bernoulli, 60, random);
    const double gap = laws::bernoulli.mean - x.mean;
    if (gap <= 0) return 0.0;
    return std::max(-700.0, -gap * gap * 60 / (2 * x.variance()));
  }));
}

// These bets win in proportion to their stake and lose nothing to variation.
TEST(BoundedMean, BetsThatDoNotPayForVariationAreNoticed) {
  EXPECT_FALSE(calibrated(282, "mutant", [](Philox& random) {
    const Moments x = draw_moments(laws::uniform, 200, random);
    const double won = 200 * (x.mean - laws::uniform.mean) / laws::uniform.mean;
    return std::min(0.0, -won / 2);
  }));
}

// ln p of the four bets alone. Variation costs this part of what it must.
double log_p_of_bets(const Moments& x, double mean, double part) {
  const double n = static_cast<double>(x.count);
  const double gap = x.mean - mean;
  double wealth = 0;
  for (const double bet : {.875, .5, .25, .125}) {
    const double psi = -std::log1p(-bet) - bet;
    wealth +=
        std::exp(bet * n * gap / mean - part * psi * (x.m2 + n * gap * gap) / mean / mean) / 4;
  }
  return std::min(0.0, -std::log(wealth));
}

TEST(BoundedMean, BetsThatPayAQuarterOfTheirVariationAreNoticed) {
  const auto of_part = [](double part) {
    return [part](Philox& random) {
      return log_p_of_bets(draw_moments(laws::uniform, 5000, random), laws::uniform.mean, part);
    };
  };
  EXPECT_TRUE(calibrated(288, "whole", of_part(1), 3000));
  EXPECT_FALSE(calibrated(288, "quarter", of_part(.25), 3000));
}

// ---- Power

double share_found(std::size_t n, double null, Range range, std::uint32_t test_case) {
  Philox random(test_case);
  double found = 0;
  for (int run = 0; run < 500; ++run) {
    const Moments x = draw_moments(laws::uniform, n, random);
    found += bounded_mean(x, range, null).log_p_upper <= std::log(1e-3) ? 1 / 500.0 : 0;
  }
  std::printf("  n = %zu against %g in [%g, %g]: %.3f\n", n, null, range.low, range.high, found);
  return found;
}

// Found in .99 of runs; fewer than 475 of 500 has probability 5e-9 then.
TEST(BoundedMean, FindsASixthOfAStandardDeviationInSixteenHundredValues) {
  share_found(1200, .45, unit, 284);
  EXPECT_GE(share_found(1600, .45, unit, 285), .95);
}

// Maurer and Pontil's bound alone finds it in a range of 1 (n = 1600), in none of a thousand.
TEST(BoundedMean, FindsValuesTooLargeWhateverTheRangeBeyondThem) {
  EXPECT_GE(share_found(1600, .45, {0, 1e3}, 286), .95);
  EXPECT_GE(share_found(1600, .45, {0, 1e9}, 287), .95);
}

}  // namespace
}  // namespace assay::stats
