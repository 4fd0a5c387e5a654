#include "stats/variances/influence.h"

#include "stats/gates/assumption_gates.h"
#include "stats/planning/power.h"
#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

using tests::joint;
using tests::Pairs;

// The data sets of make_ratios.py.
Pairs pairs(int k, int size) {
  Pairs result{.x = table_sample(k, size), .cost = {}};
  for (int i = 1; i <= size; ++i) {
    const double x = result.x[static_cast<std::size_t>(i - 1)];
    result.cost.push_back(2 + std::fmod(0.37 * k * i, 1.5) + 0.2 * std::abs(x));
  }
  return result;
}

JointMoments joint(const std::vector<double>& values) {
  return joint(Pairs{values, std::vector<double>(values.size(), 1)});
}

void expect_test(const Row& row, const std::string& name, const TestResult& found) {
  EXPECT_NEAR(found.statistic, row[name + "_t"], 1e-9 * (1 + std::abs(row[name + "_t"]))) << name;
  EXPECT_NEAR(std::exp(found.log_p_upper), row[name + "_upper"], 1e-9) << name;
}

TEST(Influence, AgreesWithTheInfluenceOfEveryObservation) {
  for (const Row& row : tests::read_table("influence")) {
    const int k = static_cast<int>(row["k"]);
    const int n = static_cast<int>(row["n"]);
    const JointMoments x = joint(pairs(k, n));
    const JointMoments y = joint(pairs(k + 3, n));
    const auto at_distance = [](const Influence& one, const Influence& two, double distance) {
      return influence_t(one, two, one.log_value - two.log_value + distance);
    };
    const Influence variance = influence_of_variance(x);
    EXPECT_NEAR(variance.log_value, row["ln_variance"], 1e-12);
    expect_test(row, "variance", influence_t(variance, variance.log_value - .3));
    expect_test(row, "variances", at_distance(variance, influence_of_variance(y), -.2));
    const Influence product = influence_of_variance_and_cost(x);
    EXPECT_NEAR(product.log_value, row["ln_product"], 1e-12);
    expect_test(row, "efficiency", influence_t(product, product.log_value + .2));
    const Influence biased = influence_of_error_and_cost(x, .1 * k);
    EXPECT_NEAR(biased.log_value, row["ln_biased"], 1e-12);
    expect_test(row, "biased", influence_t(biased, biased.log_value - .25));
    expect_test(row, "efficiencies", at_distance(product, influence_of_error_and_cost(y, .1), .1));
    expect_test(row, "costs",
                at_distance(influence_of_mean(x.cost()), influence_of_mean(y.cost()), -.03));
  }
}

// psi of every observation, summed as it stands. Fourth powers take the error of the mean.
Moments brute(const Pairs& data, double truth, bool of_error) {
  const Moments x = moments_of(data.x);
  const Moments cost = moments_of(data.cost);
  const double centre = of_error ? truth : x.mean;
  double square = 0;
  for (const double value : data.x) square += (value - centre) * (value - centre);
  square /= static_cast<double>(data.x.size());
  Moments psi;
  double products = 0;
  for (std::size_t i = 0; i < data.x.size(); ++i) {
    const double d = data.x[i] - centre;
    const double value = d * d / square + data.cost[i] / cost.mean - 1;
    psi.add(value);
    products += value * d;
  }
  if (!of_error) psi.m4 += 16 * products * products / x.m2;
  return psi;
}

TEST(Influence, HoldsAllFourMomentsAndBoundsTheExtremes) {
  for (const double offset : {0.0, 1e6}) {
    Pairs data = pairs(2, 300);
    for (double& x : data.x) x += offset;
    for (const bool of_error : {false, true}) {
      const double truth = offset + .4;
      const Moments psi = brute(data, truth, of_error);
      const JointMoments sample = joint(data);
      const Moments found = of_error ? influence_of_error_and_cost(sample, truth).relative
                                     : influence_of_variance_and_cost(sample).relative;
      EXPECT_EQ(found.mean, 1);
      EXPECT_NEAR((found.m2 - (of_error ? 0 : 2)) / psi.m2, 1, 1e-9);
      EXPECT_NEAR(found.m3 / psi.m3, 1, 1e-8);
      EXPECT_NEAR(found.m4 / psi.m4, 1, 1e-8);
      EXPECT_GE(found.maximum, psi.maximum);
      EXPECT_LE(found.minimum, psi.minimum);
    }
  }
}

// Half of the values are 1, the others -1: psi never varies, and the second order is all there is.
TEST(Influence, OfACoinHasItsSecondOrder) {
  std::vector<double> coin;
  for (int i = 0; i < 100; ++i) coin.push_back(i % 2 == 0 ? 1 : -1);
  const Influence influence = influence_of_variance(joint(coin));
  EXPECT_NEAR(influence.relative.m2, 2, 1e-9);
  EXPECT_GT(log_p_two_sided(influence_t(influence, 0)), std::log(.2));
}

TEST(Influence, OfFourMomentsIsThePlainT) {
  const std::vector<double> x = pairs(1, 60).x;
  const Influence four = influence_of_variance(joint_of_four(moments_of(x)));
  const Influence all = influence_of_variance(joint(x));
  EXPECT_NEAR(four.relative.m2 / all.relative.m2, 1, 1e-12);
  EXPECT_EQ(four.relative.m3, 0);
  const double t = (1 - std::exp(-.2)) / four.relative.standard_error();
  EXPECT_NEAR(influence_t(four, four.log_value - .2).statistic, t, 1e-12);
}

// ---- Costs that never vary

Influence always(double cost) {
  return influence_of_mean(moments_of(std::vector<double>{cost, cost, cost}));
}

// 1.15 * 100 is 114.99999999999999. One part in a million beside the quotient is another ratio.
TEST(Influence, WithoutSpreadHasTheQuotientOfWholeCostsHoweverItIsRounded) {
  for (int x = 1; x <= 150; ++x) {
    for (int y = 1; y <= 150; ++y) {
      const double ratio = std::log(static_cast<double>(x) / y);
      ASSERT_EQ(log_p_two_sided(influence_t(always(x), always(y), ratio)), 0) << x << " / " << y;
      ASSERT_LT(influence_t(always(x), always(y), ratio - 1e-6).log_p_upper, -1e300);
      ASSERT_LT(influence_t(always(x), always(y), ratio + 1e-6).log_p_lower, -1e300);
    }
  }
  EXPECT_EQ(log_p_two_sided(influence_t(always(115), std::log(1.15 * 100))), 0);
}

TEST(Influence, OneSideWithoutSpreadIsAKnownNumber) {
  const Influence cost = influence_of_mean(joint(pairs(1, 50)).cost());
  EXPECT_NEAR(influence_t(cost, always(2), std::log(1.2)).statistic,
              influence_t(cost, std::log(2.4)).statistic, 1e-9);
}

// Beyond some ratio Fieller's set has no end: the second may be 0, as far as the data tell.
TEST(Influence, ARatioOverAnUncertainQuantityIsNotExcludedHoweverLarge) {
  const Influence few = influence_of_variance(joint(std::vector<double>{0, 0, 0, 0, 0, 0, 0, 9}));
  const Influence x = influence_of_variance(joint(tests::golden_x));
  EXPECT_GT(influence_t(x, few, 100).log_p_lower, std::log(.01));
  EXPECT_EQ(influence_t(x, few, 400).log_p_lower, influence_t(x, few, 500).log_p_lower);
}

// ---- Levels

JointMoments draw(const tests::Law& law, std::size_t n, Philox& random) {
  JointSums sums;
  for (std::size_t i = 0; i < n; ++i) sums.add(law.draw(random), 0);
  return sums.moments();
}

TEST(Influence, OfAVarianceIsCalibrated) {
  expect_calibrated({911, 3000}, [](Philox& random) {
    return log_p_two_sided(
        influence_t(influence_of_variance(draw(tests::laws::normal, 3000, random)), 0));
  });
  expect_calibrated({912, 2000}, [](Philox& random) {
    const auto x = draw(tests::laws::exponential, 16384, random);
    return log_p_two_sided(influence_t(influence_of_variance(x), 0));
  });
}

CALIBRATED(Influence, OfVariancesIsCalibratedBetweenDifferentShapes, 913, 2000) {
  const auto x = influence_of_variance(draw(tests::laws::exponential, 16384, random));
  const auto y = influence_of_variance(draw(tests::laws::uniform, 4000, random));
  return log_p_two_sided(influence_t(x, y, std::log(12)));
}

// The skewness of lognormal(0, 1.5) is 33. Where few squares bear the sum, the largest were not
// seen, and two of fifty samples fail a true variance at .01. Squares of a two-valued law near 1/2
// hardly differ, and the error of the mean decides how much. Those that pass the gate are
// calibrated.
TEST(Influence, OfAVarianceKeepsItsLevelWhereTheGateIsNotRed) {
  struct Case {
    double (*draw)(Philox&);
    int count;
    double variance;
  };
  for (const Case& law :
       {Case{[](Philox& random) { return std::exp(1.5 * random.normal()); }, 4096,
             (std::exp(2.25) - 1) * std::exp(2.25)},
        Case{[](Philox& random) { return random.uniform() < .47 ? 1.0 : 0.0; }, 1000, .47 * .53},
        Case{[](Philox& random) { return random.uniform() < .45 ? 1.0 : 0.0; }, 1000, .45 * .55}}) {
    const std::size_t runs = tests::repetitions(4000);
    Philox random(925);
    double fails = 0;
    double decided = 0;
    for (std::size_t i = 0; i < runs; ++i) {
      JointSums sums;
      for (int k = 0; k < law.count; ++k) sums.add(law.draw(random), 0);
      const Influence x = influence_of_variance(sums.moments());
      if (log_p_two_sided(influence_t(x, std::log(law.variance))) > std::log(.01)) continue;
      ++fails;
      decided += effective_observations_gate({&x.relative, 1}).state != GateState::red;
    }
    const auto n = static_cast<double>(runs);
    EXPECT_TRUE(tests::too_many(fails / n, .01, n)) << fails;
    EXPECT_FALSE(tests::too_many(decided / n, .01, n)) << decided;
  }
}

// The mean of the exponential law is 1: squares about 0 have twice the mean.
CAUGHT(Influence, WithTheMeanNotSubtractedIsCaught, 914, 1000) {
  const auto x = draw(tests::laws::exponential, 4000, random);
  const double square = x.sum(2, 0) / static_cast<double>(x.count);
  Influence wrong = influence_of_variance(x);
  wrong.log_value = std::log(square + x.of_x.mean * x.of_x.mean);
  return log_p_two_sided(influence_t(wrong, 0));
}

CAUGHT(Influence, WithTheKurtosisOfTheNormalLawIsCaught, 916, 3000) {
  Influence wrong = influence_of_variance(draw(tests::laws::exponential, 4000, random));
  wrong.relative.m2 = 2 * 4000.0;
  return log_p_two_sided(influence_t(wrong, 0));
}

// x normal, cost 1 + x^2: variance times mean cost 2, relative spread 2 + 2/4 + 2 * 2/2 = 4.5.
JointMoments quadratic_cost(Philox& random, int n) {
  JointSums sample;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    sample.add(x, 1 + x * x);
  }
  return sample.moments();
}

CALIBRATED(Influence, OfAnEfficiencyIsCalibratedWhenCostFollowsTheSquare, 917, 3000) {
  const Influence x = influence_of_variance_and_cost(quadratic_cost(random, 4000));
  return log_p_two_sided(influence_t(x, std::log(2)));
}

// Exponential at cost 3 against normal at cost 1 + x^2: 3 over 2.
CALIBRATED(Influence, OfEfficienciesIsCalibratedBetweenDifferentShapes, 918, 1500) {
  JointSums x;
  for (int i = 0; i < 16384; ++i) x.add(random.exponential(), 3);
  const Influence y = influence_of_variance_and_cost(quadratic_cost(random, 4000));
  return log_p_two_sided(
      influence_t(influence_of_variance_and_cost(x.moments()), y, std::log(1.5)));
}

// Bias 1, variance 1, cost 2: mean squared error 2, product 4.
CALIBRATED(Influence, OfABiasedEstimatorIsCalibrated, 919, 4000) {
  JointSums x;
  for (int i = 0; i < 2000; ++i) x.add(random.normal(), 2);
  return log_p_two_sided(influence_t(influence_of_error_and_cost(x.moments(), -1), std::log(4)));
}

CAUGHT(Influence, WithoutTheCovarianceOfSquareAndCostIsCaught, 920, 3000) {
  const JointMoments sample = quadratic_cost(random, 2000);
  Influence wrong = influence_of_variance_and_cost(sample);
  wrong.relative.m2 -= 2 * sample.sum(2, 1) / (sample.sum(2, 0) / 2000) / sample.of_cost.mean;
  return log_p_two_sided(influence_t(wrong, std::log(2)));
}

CALIBRATED(Influence, OfCostsIsCalibrated, 921, 4000) {
  const Moments x = tests::draw_moments(2000, [&] { return random.exponential(); });
  const Moments y = tests::draw_moments(2000, [&] { return 1 + random.uniform(); });
  return log_p_two_sided(
      influence_t(influence_of_mean(x), influence_of_mean(y), std::log(2 / 3.0)));
}

// |rate - power| <= sqrt(ln(2e5) / (2 R)): .0553 at R = 2000, false alarm 1e-5.
TEST(Influence, APlannedSampleFindsTheRatioItWasPlannedFor) {
  const MeanPlan plan{.standard_deviation = std::sqrt(4.5), .rates = {.01, .2}};
  const auto n = static_cast<int>(student_t_sample_size(plan, std::log(1.1)).value());
  Philox random(922);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto x = influence_of_variance_and_cost(quadratic_cost(random, n));
    found += log_p_two_sided(influence_t(x, std::log(2 / 1.1))) <= std::log(.01);
  }
  EXPECT_NEAR(found / 2000.0, .8, .0553);
}

}  // namespace
}  // namespace assay::stats
