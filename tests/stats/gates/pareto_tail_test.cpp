#include "stats/gates/pareto_tail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/stats/calibration.h"
#include "tests/stats/laws.h"

namespace assay::stats {
namespace {

using tests::Law;
using tests::Philox;
namespace laws = tests::laws;

TEST(ParetoTail, GoldenValuesToThePrintedDigits) {
  std::vector<double> light;
  std::vector<double> heavy;
  for (int i = 100; i >= 1; --i) {
    light.push_back(-std::log((i - .5) / 100));
    heavy.push_back(std::pow((i - .5) / 100, -.7) - 1);
  }
  const GeneralisedPareto exponential = fit_generalised_pareto(light);
  EXPECT_NEAR(exponential.shape, .0656255635309009, 1e-13);
  EXPECT_NEAR(exponential.raw_shape, .022188119883991, 1e-13);
  EXPECT_NEAR(exponential.scale, .975219939083647, 1e-13);
  const GeneralisedPareto pareto = fit_generalised_pareto(heavy);
  EXPECT_NEAR(pareto.shape, .680035988100642, 1e-13);
  EXPECT_NEAR(pareto.raw_shape, .698039586910707, 1e-13);
  EXPECT_NEAR(pareto.scale, .697255811451578, 1e-13);
}

// The tail of a sample of n, ascending.
template <class Draw>
std::vector<double> largest_of(std::size_t n, Draw&& draw) {
  std::vector<double> values(n);
  for (double& value : values) value = draw();
  std::sort(values.begin(), values.end());
  values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(pareto_tail_size(n) + 1));
  return values;
}

TEST(ParetoTail, IsUnmovedByShiftAndScaleAndByFurtherValues) {
  Philox random(401);
  auto tail = largest_of(1000, [&] { return std::pow(random.uniform(), -.4); });
  const double shape = pareto_tail(tail, 1000).shape;
  std::vector<double> moved(tail);
  for (double& value : moved) value = 1e-200 * (value - 3);
  EXPECT_NEAR(pareto_tail(moved, 1000).shape, shape, 1e-9);
  tail.insert(tail.begin(), tail.front() - 5);
  EXPECT_EQ(pareto_tail(tail, 1000).shape, shape);
}

TEST(ParetoTail, TiesWithTheThresholdAreLeftOut) {
  std::vector<double> tail(96, 0.0);
  std::fill(tail.end() - 10, tail.end(), 1.0);
  EXPECT_EQ(pareto_tail(tail, 1000).exceedances, 10U);
  EXPECT_LT(pareto_tail(tail, 1000).shape, .25);
}

TEST(ParetoTail, BadArgumentsAreNamed) {
  const std::vector<double> tail{1, 2, 3, 4, 5, 6, 7};
  EXPECT_NO_THROW(pareto_tail(tail, 25));
  EXPECT_THROW(pareto_tail(tail, 1000), std::domain_error);
  EXPECT_THROW(pareto_tail(tail, 3), std::domain_error);
  EXPECT_THROW(pareto_tail(tail, 25, 1), std::domain_error);
  EXPECT_THROW(pareto_tail(std::vector<double>{1, 2, 3, 4, 6, 5}, 25), std::domain_error);
  EXPECT_THROW(pareto_tail(std::vector<double>{1, 2, 3, 4, 5, NAN}, 25), std::domain_error);
  EXPECT_THROW(pareto_tail(std::vector<double>(6, 1.0), 25), std::domain_error);
  EXPECT_THROW(fit_generalised_pareto(std::vector<double>{0, 1, 2, 3, 4}), std::domain_error);
  EXPECT_THROW(fit_generalised_pareto(std::vector<double>{1, 2, 3, 4}), std::domain_error);
}

TEST(ParetoTail, LimitsFollowTheSampleSize) {
  EXPECT_EQ(pareto_limit(TailClaim::mean, 100000), .5);
  EXPECT_EQ(pareto_limit(TailClaim::variance, 100000), .25);
  EXPECT_EQ(pareto_limit(TailClaim::any_mean, 100000), .7);
  EXPECT_NEAR(pareto_limit(TailClaim::any_mean, 1000), 1 - 1.0 / 3, 1e-15);
  EXPECT_EQ(pareto_tail_size(100), 20U);
  EXPECT_EQ(pareto_tail_size(100000), 949U);
}

// ---- Sampling law. Seed 1, streams 411 and on; false alarms 1e-5.

struct Spread {
  double mean = 0;
  double sd = 0;
  double above = 0;  // share of runs whose lower limit at .99 exceeds the true shape
};

Spread spread_of(double shape, std::size_t n, std::uint32_t test_case, int runs) {
  Philox random(test_case);
  Moments shapes;
  int above = 0;
  for (int run = 0; run < runs; ++run) {
    const auto tail = largest_of(n, [&] { return std::pow(random.uniform(), -shape); });
    const ParetoTail fit = pareto_tail(tail, n, .99);
    shapes.add(fit.shape);
    above += fit.low > shape;
  }
  return {shapes.mean, shapes.standard_deviation(), above / static_cast<double>(runs)};
}

TEST(ParetoTail, TheLowerLimitExceedsTheTrueShapeSeldomEnough) {
  std::uint32_t test_case = 411;
  for (const double shape : {.25, .5, .7}) {
    for (const std::size_t n : {200UL, 1000UL, 10000UL}) {
      if (n > 5000 && !tests::is_long()) continue;
      const int runs = n > 5000 ? 1000 : static_cast<int>(tests::repetitions(4000));
      const Spread spread = spread_of(shape, n, test_case++, runs);
      const double error = (1 + shape) / std::sqrt(static_cast<double>(pareto_tail_size(n)));
      std::printf("  shape %.2f, n = %zu: mean %.3f, sd %.3f (formula %.3f), above %.4f\n", shape,
                  n, spread.mean, spread.sd, error, spread.above);
      EXPECT_FALSE(tests::too_many(spread.above, .0125, runs));
      EXPECT_LT(spread.sd, error * 1.15);
    }
  }
}

TEST(ParetoTail, TheGateIsRedForInfiniteVarianceAndNotForLightTails) {
  Philox random(431);
  const auto gate = [&](std::size_t n, const std::function<double()>& draw, TailClaim claim) {
    return pareto_gate(largest_of(n, draw), n, claim);
  };
  // k = 1.2 at n = 20000 is 6.7 standard errors above .5. A gate that is not red has probability
  // below 1e-4.
  const auto heavy = [&] { return std::pow(random.uniform(), -1.2); };
  EXPECT_EQ(gate(20000, heavy, TailClaim::mean).state, GateState::red);
  EXPECT_EQ(gate(20000, heavy, TailClaim::any_mean).state, GateState::red);
  // Red with probability 1e-4 or less each.
  for (const Law& law : {laws::normal, laws::exponential, laws::lognormal_half, laws::lognormal_one,
                         laws::bernoulli, laws::uniform, laws::t5}) {
    for (const std::size_t n : {50UL, 1000UL, 20000UL}) {
      const Gate seen = gate(
          n, [&] { return law.draw(random); }, TailClaim::mean);
      EXPECT_NE(seen.state, GateState::red) << law.name << " " << n << " " << seen.low;
    }
  }
}

// ---- Mutants: each shifts the shape by several of its standard errors.

TEST(ParetoTail, WithoutTheThresholdTheShapeIsWrong) {
  Philox random(441);
  const auto tail = largest_of(10000, [&] { return std::pow(random.uniform(), -.5); });
  const double whole = fit_generalised_pareto(tail).shape;  // values, not exceedances
  EXPECT_GT(std::abs(whole - .5), 5 * (1.5 / std::sqrt(300)));
}

TEST(ParetoTail, ALimitAtTheWrongSideIsNoticed) {
  // Upper limit for lower: the share above the true shape becomes .99.
  Philox random(442);
  int above = 0;
  for (int run = 0; run < 500; ++run) {
    const auto tail = largest_of(1000, [&] { return std::pow(random.uniform(), -.5); });
    above += pareto_tail(tail, 1000, .01).low > .5;
  }
  EXPECT_TRUE(tests::too_many(above / 500.0, .0125, 500));
}

}  // namespace
}  // namespace assay::stats
