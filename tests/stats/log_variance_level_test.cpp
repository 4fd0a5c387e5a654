#include "stats/log_variance_level.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "stats/cost_ratio.h"
#include "stats/errors.h"
#include "stats/log_variance.h"
#include "stats/tails.h"
#include "tests/philox.h"

namespace assay::stats {
namespace {

// Standardised moments of the exponential law: subfactorials 2, 9, 44, 265.
constexpr SixthOrderShape exponential{.skewness = 2, .kurtosis = 9, .fifth = 44, .sixth = 265};
constexpr SixthOrderShape normal{};

// Of the gamma law of this shape a, from its cumulants (r - 1)! / a^(r / 2 - 1).
SixthOrderShape gamma_law(double a) {
  const double k3 = 2 / std::sqrt(a);
  const double k4 = 6 / a;
  const double k5 = 24 / std::pow(a, 1.5);
  const double k6 = 120 / (a * a);
  return {.skewness = k3,
          .kurtosis = 3 + k4,
          .fifth = k5 + 10 * k3,
          .sixth = k6 + 15 * k4 + 10 * k3 * k3 + 15};
}

TEST(SixthOrderShape, IsThatOfTheValues) {
  const SixthOrderShape shape = sixth_order_shape(std::vector<double>{1, 2, 4, 9});
  // numpy: d = x - 4; [(d**r).mean() / (d**2).mean()**(r/2) for r in (3, 4, 5, 6)]
  EXPECT_NEAR(shape.skewness, 0.7684172579878226, 1e-9);
  EXPECT_NEAR(shape.kurtosis, 2.0, 1e-9);
  EXPECT_NEAR(shape.fifth, 2.5613908599594084, 1e-9);
  EXPECT_NEAR(shape.sixth, 4.787286776498032, 1e-9);
  EXPECT_THROW(sixth_order_shape(std::vector<double>{3, 3}), ZeroVariance);
  EXPECT_THROW(sixth_order_shape(std::vector<double>{3}), std::domain_error);
}

TEST(SixthOrderShape, OfMeansOfExponentialsIsAGammaLaws) {
  for (const std::uint64_t count : {1U, 2U, 7U, 100U}) {
    const SixthOrderShape mean = averaged(exponential, count);
    const SixthOrderShape gamma = gamma_law(static_cast<double>(count));
    EXPECT_NEAR(mean.skewness, gamma.skewness, 1e-12) << count;
    EXPECT_NEAR(mean.kurtosis, gamma.kurtosis, 1e-12) << count;
    EXPECT_NEAR(mean.fifth, gamma.fifth, 1e-11) << count;
    EXPECT_NEAR(mean.sixth, gamma.sixth, 1e-11) << count;
  }
}

// Of the normal law psi = chi2_1 - 1 has skewness sqrt 8: B = (sqrt 8 / 3 - sqrt 2 / 2) / sqrt n.
TEST(LogVarianceLevel, IsTheFormula) {
  const PlannedLogVariance plan{.count = 1000, .critical_value = 2.3263};
  const double cube = 2.3263 * 2.3263 * 2.3263;
  const double of_normal = (std::sqrt(8) / 3 - std::sqrt(2) / 2) / std::sqrt(1000);
  EXPECT_NEAR(log_variance_level_factor(normal, plan), std::exp(of_normal * cube), 1e-12);
  EXPECT_NEAR(log_variance_level_factor(exponential, plan),
              std::exp(2.121320343559643 / std::sqrt(1000) * cube), 1e-9);
  EXPECT_NEAR(log_variance_level_factor(normal, normal, plan),
              std::exp(2 * std::pow(0.5, 1.5) * of_normal * cube), 1e-12);
}

TEST(LogVarianceLevel, NeedsTheCountAtWhichItsFactorIsTheLimit) {
  const std::uint64_t count = values_for_log_variance(exponential, 3);
  EXPECT_LE(log_variance_level_factor(exponential, {.count = count, .critical_value = 3}), 1.25);
  EXPECT_GT(log_variance_level_factor(exponential, {.count = count - 1, .critical_value = 3}),
            1.25);
  EXPECT_EQ(values_for_log_variance({.kurtosis = 1, .sixth = 1}, 3), 2U) << "two values, evenly";
}

// Exponential values at the count it asks for: the lower tail's rate at .01 is at most 1.25 times
// nominal, at a twentieth of that count it is beyond. 8000 repetitions, so that a rate of 1.25
// shows as more than 1.8 with probability 1e-5 (binomial), and of 2.2 as less than 1.5 with 1e-5.
TEST(LogVarianceLevel, KeepsTheLevelWhereItSays) {
  const double z = normal_quantile({Tail::upper, std::log(0.01)});
  const std::uint64_t enough = values_for_log_variance(exponential, z);
  tests::Philox random(7001);
  const auto rate = [&](std::uint64_t count) {
    int rejected = 0;
    for (int run = 0; run < 8000; ++run) {
      Moments x;
      for (std::uint64_t i = 0; i < count; ++i) x.add(random.exponential());
      if (log_variance(x, 1).statistic < -z) ++rejected;
    }
    return rejected / 8000.0 / 0.01;
  };
  EXPECT_LE(rate(enough), 1.8);
  EXPECT_GE(rate(enough / 20), 1.5);
}

// A cost of 1, with probability .1 exponential ones more, 10 on average: at the count found ln of
// its mean keeps its lower tail within some 1.25 times .01, at a twentieth not within 1.5 times.
TEST(LogVarianceLevel, OfAMeanKeepsTheLevelWhereItSays) {
  const double z = normal_quantile({Tail::upper, std::log(0.01)});
  const double deviation = std::sqrt(19);                // 10^2 (2 p - p^2)
  const double skewness = 542 / std::pow(deviation, 3);  // 10^3 (6 p - 6 p^2 + 2 p^3)
  const std::uint64_t enough =
      values_for_log_mean({.variation = deviation / 2, .skewness = skewness}, z);
  tests::Philox random(7002);
  const auto rate = [&](std::uint64_t count) {
    int rejected = 0;
    for (int run = 0; run < 8000; ++run) {
      Moments cost;
      for (std::uint64_t i = 0; i < count; ++i) {
        const bool more = random.uniform() < .1;
        cost.add(more ? 1 + 10 * random.exponential() : 1);
      }
      if (cost.m2 == 0 || log_cost(cost, 2).statistic < -z) ++rejected;
    }
    return rejected / 8000.0 / 0.01;
  };
  EXPECT_LE(rate(enough), 1.8);
  EXPECT_GE(rate(enough / 20), 1.5);
}

}  // namespace
}  // namespace assay::stats
