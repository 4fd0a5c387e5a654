#include "stats/bounded_mean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "stats/betting_mean.h"
#include "stats/bounded_process.h"
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
  for (const Row& row : tests::read_table("bounded_mean")) {
    const auto x = fractions(static_cast<int>(row["k"]), static_cast<int>(row["n"]));
    const TestResult result = bounded_mean(moments_of(rescaled(x, {-2, 3})), {-2, 3}, row["null"]);
    expect_log_p(result.log_p_lower, row["log_lower"]);
    expect_log_p(result.log_p_upper, row["log_upper"]);
    EXPECT_EQ(result.exactness, Exactness::exact);
    EXPECT_EQ(result.distribution.family, "bound");
  }
}

TEST(BoundedMean, IntervalEndsAreJustRejected) {
  const Moments x = moments_of(fractions(3, 500));
  const Interval interval = bounded_mean_interval(x, unit, .998);
  EXPECT_NEAR(bounded_mean(x, unit, interval.low).log_p_upper, std::log(.001), 1e-9);
  EXPECT_NEAR(bounded_mean(x, unit, interval.high).log_p_lower, std::log(.001), 1e-9);
}

TEST(BoundedMean, AConstantSampleStillHasAnInterval) {
  const Moments zeros = moments_of(std::vector<double>(1000, 0.0));
  const Interval interval = bounded_mean_interval(zeros, unit, .98);
  EXPECT_EQ(interval.low, 0);
  // (1 - high)^1000 = .005, the Clopper-Pearson limit at half the error.
  EXPECT_NEAR(interval.high, 1 - std::pow(.005, 1e-3), 1e-12);
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
  EXPECT_THROW(bounded_mean_interval(x, unit, 1), std::domain_error);
  EXPECT_THROW(bounded_mean(moments_of(std::vector<double>{.5}), unit, .3), std::domain_error);
}

// ---- Betting

TEST(BettingMean, GoldenValuesToThePrintedDigits) {
  BettingMean process({unit, .05}, .45);
  for (const double value : fractions(1, 200)) process.add(value);
  EXPECT_NEAR(process.log_e_above(), 2.563237341106409, 1e-12);
  EXPECT_NEAR(process.log_e_below(), -8.484000807664927, 1e-12);
  EXPECT_NEAR(log_p_two_sided(process.result()), -1.8700901605464635, 1e-12);
}

TEST(BettingMean, DoesNotDependOnTheScale) {
  const auto x = fractions(2, 300);
  const TestResult plain = betting_mean(x, {unit, .01}, .4);
  const TestResult scaled = betting_mean(rescaled(x, {-3, 7}), {{-3, 7}, .01}, 1);
  EXPECT_NEAR(plain.log_p_lower, scaled.log_p_lower, 1e-10);
  EXPECT_NEAR(plain.log_p_upper, scaled.log_p_upper, 1e-10);
}

TEST(BettingMean, IntervalEndsAreJustRejected) {
  const auto x = fractions(3, 400);
  const Betting betting{unit, .01};
  const Interval interval = betting_mean_interval(x, betting, .98);
  EXPECT_NEAR(betting_mean(x, betting, interval.low).log_p_upper, std::log(.01), 1e-9);
  EXPECT_NEAR(betting_mean(x, betting, interval.high).log_p_lower, std::log(.01), 1e-9);
}

TEST(BettingMean, AnImpossibleMeanIsRejectedOutright) {
  const std::vector<double> x{.5, 0, .25};
  EXPECT_EQ(betting_mean(x, {}, 0).log_p_upper, std::numeric_limits<double>::lowest());
  EXPECT_EQ(betting_mean(x, {}, 1.5).log_p_lower, std::numeric_limits<double>::lowest());
  EXPECT_EQ(betting_mean(std::vector<double>{0, 0}, {}, 0).log_p_upper, 0);
}

TEST(BettingMean, BadArgumentsAreNamed) {
  EXPECT_THROW(BettingMean({{1, 1}, .01}, .5), std::domain_error);
  EXPECT_THROW(BettingMean({unit, 0}, .5), std::domain_error);
  EXPECT_THROW(BettingMean({unit, .01}, NAN), std::domain_error);
  BettingMean process({unit, .01}, .5);
  EXPECT_THROW(process.add(1.5), std::domain_error);
  EXPECT_THROW(process.add(NAN), std::domain_error);
  EXPECT_THROW(process.result(), std::domain_error);
}

// ---- Blocks

BoundedProcess process_of(const std::vector<double>& x, const BoundedDesign& design,
                          const std::vector<std::size_t>& ends) {
  BoundedProcess process(design);
  std::size_t first = 0;
  for (const std::size_t last : ends) {
    process.add(moments_of(std::span(x).subspan(first, last - first)));
    first = last;
  }
  return process;
}

TEST(BoundedProcess, AgreesWithTheSumValueByValue) {
  for (const Row& row : tests::read_table("bounded_process")) {
    const Range range{-1, 3};
    const auto x = rescaled(fractions(static_cast<int>(row["k"]), 600), range);
    const auto planned = static_cast<std::uint64_t>(row["planned"]);
    const auto process = process_of(x, {range, row["error"], planned}, {100, 150, 400, 600});
    const TestResult result = process.result(-1 + 4 * row["null"]);
    expect_log_p(result.log_p_lower, row["log_lower"]);
    expect_log_p(result.log_p_upper, row["log_upper"]);
    const Interval interval = process.interval(.99);
    EXPECT_NEAR(interval.low, -1 + 4 * row["low_99"], 1e-11);
    EXPECT_NEAR(interval.high, -1 + 4 * row["high_99"], 1e-11);
  }
}

TEST(BoundedProcess, IntervalEndsAreJustRejected) {
  const auto process = process_of(fractions(2, 900), {unit, .01}, {300, 600, 900});
  const Interval interval = process.interval(.98);
  EXPECT_NEAR(process.result(interval.low).log_p_upper, std::log(.01), 1e-9);
  EXPECT_NEAR(process.result(interval.high).log_p_lower, std::log(.01), 1e-9);
}

TEST(BoundedProcess, BadArgumentsAreNamed) {
  EXPECT_THROW(BoundedProcess(BoundedDesign{{0, INFINITY}}), std::domain_error);
  EXPECT_THROW(BoundedProcess(BoundedDesign{unit, 1}), std::domain_error);
  BoundedProcess process(BoundedDesign{unit});
  EXPECT_THROW(process.result(.5), std::domain_error);
  EXPECT_THROW(process.add(moments_of(std::vector<double>{.5, 2})), std::domain_error);
  process.add(moments_of(std::vector<double>{.5}));
  EXPECT_THROW(process.result(NAN), std::domain_error);
  EXPECT_THROW(process.interval(0), std::domain_error);
  EXPECT_EQ(process.result(-1).log_p_upper, std::numeric_limits<double>::lowest());
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

// The smallest p over looks at 50, 100, ..., 400: what a stopping rule could report.
template <class Process>
double best_of_looks(Process process, const Law& law, Philox& random, bool upper) {
  double best = 0;
  for (int look = 0; look < 8; ++look) {
    const auto values = draw_values(law, 50, random);
    if constexpr (std::is_same_v<Process, BettingMean>) {
      for (const double value : values) process.add(value);
      best = std::min(best, upper ? process.result().log_p_upper : process.result().log_p_lower);
    } else {
      process.add(moments_of(values));
      const TestResult result = process.result(law.mean);
      best = std::min(best, upper ? result.log_p_upper : result.log_p_lower);
    }
  }
  return best;
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

TEST(BettingMean, KeepsItsLevelUnderOptionalStopping) {
  std::uint32_t test_case = 261;
  for (const Law& law : bounded_laws) {
    for (const bool upper : {false, true}) {
      EXPECT_TRUE(calibrated(test_case++, law.name, [&](Philox& random) {
        return best_of_looks(BettingMean({unit, .01}, law.mean), law, random, upper);
      }));
    }
  }
}

TEST(BoundedProcess, KeepsItsLevelUnderOptionalStopping) {
  std::uint32_t test_case = 271;
  for (const Law& law : bounded_laws) {
    for (const bool upper : {false, true}) {
      EXPECT_TRUE(calibrated(test_case++, law.name, [&](Philox& random) {
        return best_of_looks(BoundedProcess({unit, .01}), law, random, upper);
      }));
    }
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

TEST(BettingMean, ABetPlacedAfterTheValueIsSeenIsNoticed) {
  EXPECT_FALSE(calibrated(282, "mutant", [](Philox& random) {
    double log_wealth = 0;
    for (int i = 0; i < 200; ++i) {
      const double x = random.uniform();
      log_wealth += std::log1p((x > .5 ? .5 : .1) * (x - .5));
    }
    return std::min(0.0, -log_wealth);
  }));
}

TEST(BoundedProcess, AForecastFromTheBlockItselfIsNoticed) {
  EXPECT_FALSE(calibrated(
      283, "mutant",
      [](Philox& random) {
        // Blocks of one value: the block's own mean leaves no variation to pay for.
        double log_e = 0;
        for (int i = 1; i <= 400; ++i) {
          const double bet =
              std::min(.5, std::sqrt(2 * std::log(200.0) / (i * std::log1p(i) / 12)));
          log_e += bet * (random.uniform() - .5);
        }
        return std::min(0.0, -log_e);
      },
      20000));
}

// ---- Power: uniform values against .45, a sixth of a standard deviation away, at 1e-3

struct Found {
  double fixed = 0, betting = 0, blocks = 0;
};

Found share_found(std::size_t n, std::uint32_t test_case) {
  Philox random(test_case);
  Found found;
  const auto hit = [](const TestResult& result) {
    return result.log_p_upper <= std::log(1e-3) ? 1 / 500.0 : 0;
  };
  for (int run = 0; run < 500; ++run) {
    const auto values = draw_values(laws::uniform, n, random);
    found.fixed += hit(bounded_mean(moments_of(values), unit, .45));
    found.betting += hit(betting_mean(values, {unit, 1e-3}, .45));
    BoundedProcess process({unit, 1e-3, n});
    for (std::size_t b = 0; b < 20; ++b) {
      process.add(moments_of(std::span(values).subspan(b * (n / 20), n / 20)));
    }
    found.blocks += hit(process.result(.45));
  }
  std::printf("  n = %zu: fixed %.3f, betting %.3f, blocks %.3f\n", n, found.fixed, found.betting,
              found.blocks);
  return found;
}

TEST(BoundedMean, EachMethodFindsASixthOfAStandardDeviationInTwoThousandValues) {
  share_found(1200, 284);
  // Each finds it in at least .98 of runs; fewer than 475 of 500 has probability 5e-5 at .98.
  const Found found = share_found(2000, 285);
  EXPECT_GE(found.fixed, .95);
  EXPECT_GE(found.betting, .95);
  EXPECT_GE(found.blocks, .95);
}

}  // namespace
}  // namespace assay::stats
