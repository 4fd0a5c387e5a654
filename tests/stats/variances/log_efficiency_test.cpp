#include "stats/variances/log_efficiency.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "stats/basics/errors.h"
#include "stats/planning/power.h"
#include "stats/tails/tails.h"
#include "stats/variances/cost_ratio.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

using tests::expect_calibrated;
using tests::expect_caught;
using tests::Experiment;
using tests::moments_of;
using tests::Philox;
using tests::Row;

// The data sets of make_ratios.py.
struct Pairs {
  std::vector<double> x;
  std::vector<double> cost;
};

Pairs pairs(int k, int size) {
  Pairs result;
  for (int i = 1; i <= size; ++i) {
    const double tooth = 1 + std::fmod(0.05 * k * i, 3);
    result.x.push_back(std::cos(i * (0.7 + 0.1 * k)) * tooth + 0.01 * k * i + 0.3 * k);
    result.cost.push_back(2 + std::fmod(0.37 * k * i, 1.5) + 0.2 * std::abs(result.x.back()));
  }
  return result;
}

JointMoments joint(const Pairs& pairs) {
  JointMoments result;
  for (std::size_t i = 0; i < pairs.x.size(); ++i) result.add(pairs.x[i], pairs.cost[i]);
  return result;
}

TEST(JointMoments, AgreeWithTheirDefinition) {
  const Pairs data = pairs(2, 57);
  const JointMoments moments = joint(data);
  double m11 = 0;
  double m21 = 0;
  for (std::size_t i = 0; i < data.x.size(); ++i) {
    const double d = data.x[i] - moments.x.mean;
    m11 += d * (data.cost[i] - moments.cost.mean);
    m21 += d * d * (data.cost[i] - moments.cost.mean);
  }
  EXPECT_NEAR(moments.m11 / m11, 1, 1e-12);
  EXPECT_NEAR(moments.m21 / m21, 1, 1e-12);
  EXPECT_EQ(moments.x, moments_of(data.x));
  EXPECT_EQ(moments.cost, moments_of(data.cost));
}

TEST(JointMoments, MergedPartsEqualOnePass) {
  const Pairs data = pairs(3, 100);
  const JointMoments whole = joint(data);
  for (const std::size_t cut :
       {std::size_t{0}, std::size_t{1}, std::size_t{37}, std::size_t{100}}) {
    JointMoments left;
    JointMoments right;
    for (std::size_t i = 0; i < 100; ++i) (i < cut ? left : right).add(data.x[i], data.cost[i]);
    left.merge(right);
    EXPECT_EQ(left.x.count, 100U);
    EXPECT_NEAR(left.m11 / whole.m11, 1, 1e-12);
    EXPECT_NEAR(left.m21 / whole.m21, 1, 1e-12);
  }
}

TEST(JointMoments, AConstantCostLeavesExactZeros) {
  JointMoments moments;
  for (const double x : tests::golden_x) moments.add(x, 3.3);
  EXPECT_EQ(moments.cost.m2, 0);
  EXPECT_EQ(moments.m11, 0);
  EXPECT_EQ(moments.m21, 0);
}

TEST(LogEfficiency, AgreesWithTheInfluenceOfEveryObservation) {
  for (const Row& row : tests::read_table("log_efficiency")) {
    const int k = static_cast<int>(row["k"]);
    const JointMoments x = joint(pairs(k, static_cast<int>(row["n"])));
    const JointMoments y = joint(pairs(k + 3, static_cast<int>(row["n"])));
    const LogEfficiency own = log_efficiency_of(x);
    EXPECT_NEAR(own.value, row["value"], 1e-11);
    EXPECT_NEAR(own.standard_error() / row["error"], 1, 1e-11);
    const LogEfficiency biased = log_efficiency_of(x, 0.1 * k);
    EXPECT_NEAR(biased.value, row["biased"], 1e-11);
    EXPECT_NEAR(biased.standard_error() / row["biased_error"], 1, 1e-11);
    const TestResult ratio = log_efficiency_ratio(own, log_efficiency_of(y), 1.5);
    EXPECT_NEAR(ratio.statistic, row["ratio_z"], 1e-10);
    EXPECT_NEAR(std::exp(ratio.log_p_upper) / row["ratio_upper"], 1, 1e-9);
    EXPECT_NEAR(log_cost_ratio(x.cost, y.cost, 1.1).statistic / row["cost_z"], 1, 1e-11);
  }
}

TEST(LogEfficiency, IntervalsEndWhereTheTestIsAtItsLevel) {
  const LogEfficiency x = log_efficiency_of(joint(pairs(1, 50)));
  const LogEfficiency y = log_efficiency_of(joint(pairs(2, 50)));
  const Interval one = log_efficiency_interval(x, .2, .98);
  EXPECT_NEAR(std::exp(log_efficiency(x, .2 * std::exp(one.low)).log_p_upper), .01, 1e-9);
  EXPECT_NEAR(std::exp(log_efficiency(x, .2 * std::exp(one.high)).log_p_lower), .01, 1e-9);
  const Interval two = log_efficiency_ratio_interval(x, y, .98);
  EXPECT_NEAR(std::exp(log_efficiency_ratio(x, y, std::exp(two.low)).log_p_upper), .01, 1e-9);
  EXPECT_NEAR(std::exp(log_efficiency_ratio(x, y, std::exp(two.high)).log_p_lower), .01, 1e-9);
}

TEST(LogEfficiency, RefusesWhatHasNoEfficiency) {
  JointMoments constant;
  for (int i = 0; i < 5; ++i) constant.add(2, 1);
  EXPECT_THROW(log_efficiency_of(constant), ZeroVariance);
  EXPECT_THROW(log_efficiency_of(constant, 1), ZeroVariance);
  EXPECT_THROW(log_efficiency_of(constant, std::nan("")), std::domain_error);
  JointMoments free;
  for (const double x : tests::golden_x) free.add(x, 0);
  EXPECT_THROW(log_efficiency_of(free), std::domain_error);
  const LogEfficiency x = log_efficiency_of(joint(pairs(1, 50)));
  EXPECT_THROW(log_efficiency(x, 0), std::domain_error);
  EXPECT_THROW(log_efficiency(x, std::nan("")), std::domain_error);
  EXPECT_THROW(log_efficiency_interval(x, 1, 1), std::domain_error);
}

TEST(CostRatio, ConstantCostsAreComparedExactly) {
  const Moments three = moments_of(std::vector<double>{3, 3, 3});
  const Moments two = moments_of(std::vector<double>{2, 2, 2});
  const TestResult equal = log_cost_ratio(three, two, 1.5);
  EXPECT_EQ(log_p_two_sided(equal), 0);
  EXPECT_EQ(equal.exactness, Exactness::exact);
  const TestResult above = log_cost_ratio(three, two, 1.4999999);
  EXPECT_LT(above.log_p_upper, -1e300);
  EXPECT_EQ(above.log_p_lower, 0);
  EXPECT_LT(log_cost(three, 4).log_p_lower, -1e300);
  const Interval point = log_cost_ratio_interval(three, two, .99);
  EXPECT_EQ(point.low, point.high);
  EXPECT_DOUBLE_EQ(point.low, std::log(3) - std::log(2));
}

Moments always(double cost) { return moments_of(std::vector<double>{cost, cost, cost}); }

// 1.15 * 100 is 114.99999999999999. One part in a million beside the quotient is another ratio.
TEST(Cost, ThatNeverVariesHasTheQuotientOfWholeCostsHoweverItIsRounded) {
  for (int x = 1; x <= 150; ++x) {
    for (int y = 1; y <= 150; ++y) {
      const Moments cost_x = always(x);
      const Moments cost_y = always(y);
      const double ratio = std::exp(std::log(static_cast<double>(x) / y));
      ASSERT_EQ(log_p_two_sided(log_cost_ratio(cost_x, cost_y, ratio)), 0) << x << " / " << y;
      ASSERT_LT(log_cost_ratio(cost_x, cost_y, ratio * (1 - 1e-6)).log_p_upper, -1e300);
      ASSERT_LT(log_cost_ratio(cost_x, cost_y, ratio * (1 + 1e-6)).log_p_lower, -1e300);
    }
  }
  EXPECT_EQ(log_p_two_sided(log_cost(always(115), 1.15 * 100)), 0);
}

TEST(CostRatio, IntervalsEndWhereTheTestIsAtItsLevel) {
  const Moments cost = joint(pairs(1, 50)).cost;
  const Moments two = moments_of(std::vector<double>{2, 2, 2});
  const Interval one = log_cost_interval(cost, 2, .9);
  EXPECT_NEAR(std::exp(log_cost(cost, 2 * std::exp(one.low)).log_p_upper), .05, 1e-9);
  const Interval ratio = log_cost_ratio_interval(cost, two, .9);
  EXPECT_NEAR(ratio.low, one.low, 1e-12);
  EXPECT_NEAR(log_cost_ratio(cost, two, 1.2).statistic, log_cost(cost, 2.4).statistic, 1e-9);
  EXPECT_THROW(log_cost(cost, -1), std::domain_error);
  EXPECT_THROW(log_cost_ratio(moments_of(std::vector<double>{-1, 0}), two, 1), std::domain_error);
}

// x normal, cost 1 + x^2: efficiency 1/2, spread 2 + 2/4 + 2 * 2/2 = 4.5.
JointMoments quadratic_cost(Philox& random, int n) {
  JointMoments sample;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    sample.add(x, 1 + x * x);
  }
  return sample;
}

TEST(LogEfficiency, IsCalibratedWhenCostFollowsTheSquare) {
  expect_calibrated({311, 3000}, [](Philox& random) {
    return log_p_two_sided(log_efficiency(log_efficiency_of(quadratic_cost(random, 3000)), .5));
  });
}

TEST(LogEfficiency, RatioIsCalibratedBetweenDifferentShapes) {
  // Exponential at cost 3 against normal at cost 1 + x^2: 1/3 over 1/2.
  expect_calibrated({312, 2000}, [](Philox& random) {
    JointMoments x;
    for (int i = 0; i < 4000; ++i) x.add(random.exponential(), 3);
    const auto y = log_efficiency_of(quadratic_cost(random, 4000));
    return log_p_two_sided(log_efficiency_ratio(log_efficiency_of(x), y, 2 / 3.0));
  });
}

// Bias 1, variance 1, cost 2: MSE 2.
TEST(LogEfficiency, OfABiasedEstimatorIsCalibrated) {
  expect_calibrated({313, 4000}, [](Philox& random) {
    JointMoments x;
    for (int i = 0; i < 2000; ++i) x.add(random.normal(), 2);
    return log_p_two_sided(log_efficiency(log_efficiency_of(x, -1), .25));
  });
}

TEST(LogEfficiency, ForgettingTheCovarianceOfSquareAndCostIsCaught) {
  expect_caught({315, 3000}, [](Philox& random) {
    const JointMoments sample = quadratic_cost(random, 1000);
    LogEfficiency wrong = log_efficiency_of(sample);
    wrong.spread -= 2 * sample.m21 / sample.x.m2 / sample.cost.mean;
    return log_p_two_sided(log_efficiency(wrong, .5));
  });
}

TEST(CostRatio, IsCalibratedOnExponentialCosts) {
  expect_calibrated({316, 4000}, [](Philox& random) {
    const Moments x = tests::draw_moments(2000, [&] { return random.exponential(); });
    const Moments y = tests::draw_moments(2000, [&] { return 1 + random.uniform(); });
    return log_p_two_sided(log_cost_ratio(x, y, 2 / 3.0));
  });
}

TEST(CostRatio, AnErrorNotDividedByTheMeanIsCaught) {
  expect_caught({317, 2000}, [](Philox& random) {
    const Moments x = tests::draw_moments(500, [&] { return 2 * random.exponential(); });
    const double z = std::log(x.mean / 2) / x.standard_error();
    const LogTails tails = normal_tails(z);
    return std::min(0.0, std::numbers::ln2 + std::min(tails.lower, tails.upper));
  });
}

// |rate - power| <= sqrt(ln(2e5) / (2 R)): .0553 at R = 2000, false alarm 1e-5.
TEST(LogEfficiency, APlannedSampleFindsTheRatioItWasPlannedFor) {
  const LogVariancePlan plan{.kurtosis_x = 5.5, .kurtosis_y = 1, .rates = {.01, .2}};
  const auto n = static_cast<int>(log_variance_sample_size(plan, 1.2).value());
  Philox random(318);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto x = log_efficiency_of(quadratic_cost(random, n));
    found += log_p_two_sided(log_efficiency(x, .5 / 1.2)) <= std::log(.01);
  }
  EXPECT_NEAR(found / 2000.0, .8, .0553);
}

}  // namespace
}  // namespace assay::stats
