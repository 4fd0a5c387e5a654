#include "stats/gates/log_variance_level.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "stats/basics/errors.h"
#include "stats/tails/tails.h"
#include "stats/variances/cost_ratio.h"
#include "stats/variances/log_variance.h"
#include "tests/philox.h"
#include "tests/stats/calibration.h"

namespace assay::stats {
namespace {

// Standardised moments of the exponential law: subfactorials 2, 9, 44, 265.
constexpr SixthOrderShape exponential{.skewness = 2, .kurtosis = 9, .fifth = 44, .sixth = 265};
constexpr SixthOrderShape normal{};

// The gamma law of this shape a, from its cumulants (r - 1)! / a^(r / 2 - 1).
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

// For the normal law psi = chi2_1 - 1 has skewness sqrt 8: B = (sqrt 8 / 3 - sqrt 2 / 2) / sqrt n.
TEST(LogVarianceLevel, IsTheFormula) {
  const double cube = 2.3263 * 2.3263 * 2.3263;
  const double unit = cube / std::log(1.01);
  const auto count = [&](double slope) { return std::ceil(slope * unit * slope * unit); };
  const double of_normal = std::sqrt(8) / 3 - std::sqrt(2) / 2;
  EXPECT_NEAR(static_cast<double>(values_for_log_variance(normal, 2.3263, 1.01)), count(of_normal),
              1);
  EXPECT_NEAR(static_cast<double>(values_for_log_variance(exponential, 2.3263, 1.01)),
              count(2.121320343559643), 1);
  EXPECT_NEAR(static_cast<double>(values_for_log_variance(normal, normal, 2.3263, 1.01)),
              count(2 * std::pow(0.5, 1.5) * of_normal), 1);
  EXPECT_EQ(values_for_log_variance({.kurtosis = 1, .sixth = 1}, 3), 2U) << "two values, evenly";
}

TEST(LogVarianceLevel, OfUnequalSizesIsThatOfTheSamplesExchanged) {
  for (const double allocation : {1.6, 4.0}) {
    const auto one =
        static_cast<double>(values_for_log_variance(exponential, normal, 3, 1.01, allocation));
    const auto other =
        static_cast<double>(values_for_log_variance(normal, exponential, 3, 1.01, 1 / allocation));
    EXPECT_NEAR(other / one, allocation, 1e-4);
  }
  // With far more values of the second only the first is uncertain.
  EXPECT_NEAR(static_cast<double>(values_for_log_variance(exponential, normal, 3, 1.25, 1e12)) /
                  static_cast<double>(values_for_log_variance(exponential, 3)),
              1, 1e-4);
}

// Exponential values at the count it asks for. The lower tail's rate at .01 is at most 1.25 times
// nominal. At a twentieth of that count it is beyond: at 2.2 times, 8000 repetitions show it.
TEST(LogVarianceLevel, KeepsTheLevelWhereItSays) {
  const double z = normal_quantile({Tail::upper, std::log(0.01)});
  const std::uint64_t enough = values_for_log_variance(exponential, z);
  tests::Philox random(7001);
  const auto is_off = [&](std::uint64_t count, std::size_t runs) {
    double rejected = 0;
    for (std::size_t run = 0; run < runs; ++run) {
      Moments x;
      for (std::uint64_t i = 0; i < count; ++i) x.add(random.exponential());
      if (log_variance(x, 1).statistic < -z) ++rejected;
    }
    const auto all = static_cast<double>(runs);
    return tests::too_many(rejected / all, 0.0125, all);
  };
  EXPECT_FALSE(is_off(enough, tests::repetitions(8000)));
  EXPECT_TRUE(is_off(enough / 20, 8000));
}

// A cost of 1 and, with probability .1, exponential ones more, 10 on average. At the count found
// the lower tail of ln of its mean is about 1.25 times .01 at most. At a twentieth it exceeds 1.5
// times.
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

// Exact tail of ln of the mean of `count` costs, in units of the nominal tail. A cost is 1 or, once
// in a thousand, `more` dearer. The lower tail, or with sign -1 the upper.
double tail_of_costs(double more, std::uint64_t count, double z, double sign = 1) {
  constexpr double p = 0.001;
  const double n = static_cast<double>(count);
  double sum = 0;
  for (double k = 0; k < n * p + 12 * std::sqrt(n * p) + 30 && k <= n; ++k) {
    const double share = k / n;
    const double mean = 1 + more * share;
    const double error = more * std::sqrt(share * (1 - share) / (n - 1)) / mean;
    if (sign * std::log(mean / (1 + more * p)) >= -z * error) continue;
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) +
                    k * std::log(p) + (n - k) * std::log1p(-p));
  }
  return sum / std::exp(normal_upper(z));
}

// The rare costs make up twice what the others do. Then the skewness of the mean and the bend of
// the logarithm cancel. To first order 1000 observations would do, but 37 % of such samples have no
// dear one.
TEST(LogVarianceLevel, OfRareCostsIsKeptWhereTheFirstOrderVanishes) {
  constexpr double p = 0.001;
  const double deviation = std::sqrt(p * (1 - p));
  for (const double tail : {0.05, 0.025, 0.005}) {
    const double z = normal_quantile({Tail::upper, std::log(tail)});
    EXPECT_GT(tail_of_costs(1700, 1000, z), 7) << tail;
    for (const double more : {100.0, 1000.0, 1700.0, 3000.0, 1e5}) {
      const PositiveShape cost{.variation = more * deviation / (1 + more * p),
                               .skewness = (1 - 2 * p) / deviation};
      const std::uint64_t enough = values_for_log_mean(cost, z);
      EXPECT_LE(tail_of_costs(more, enough, z), 1.6) << tail << " " << more;
      EXPECT_LE(tail_of_costs(more, enough, z, -1), 1.6) << tail << " " << more;
    }
  }
}

// The same for a variance: normal values with one of 41 deviations in a thousand. At the count
// found the rate is at most 1.8 times .025. Of 2000 runs more than 120 then have probability .001.
TEST(LogVarianceLevel, OfRareOutliersIsKeptWhereTheFirstOrderVanishes) {
  constexpr double p = 0.001;
  const double far = std::sqrt(1700);
  double moments[7] = {};
  constexpr double of_normal[] = {1, 0, 1, 0, 3, 0, 15};
  for (const auto& [share, at] : {std::pair(1 - p, -p * far), std::pair(p, far - p * far)}) {
    for (int r = 0; r <= 6; ++r) {
      double choose = 1;
      for (int j = 0; j <= r; ++j) {
        moments[r] += share * choose * std::pow(at, r - j) * of_normal[j];
        choose = choose * (r - j) / (j + 1);
      }
    }
  }
  const auto standardised = [&](int r) { return moments[r] / std::pow(moments[2], r / 2.0); };
  const SixthOrderShape shape{.skewness = standardised(3),
                              .kurtosis = standardised(4),
                              .fifth = standardised(5),
                              .sixth = standardised(6)};
  const double z = normal_quantile({Tail::upper, std::log(0.025)});
  tests::Philox random(7003);
  const auto too_low = [&](std::uint64_t count) {
    int rejected = 0;
    for (int run = 0; run < 2000; ++run) {
      Moments x;
      for (std::uint64_t i = 0; i < count; ++i) {
        x.add(random.normal() + (random.uniform() < p ? far : 0));
      }
      if (log_variance(x, moments[2]).statistic < -z) ++rejected;
    }
    return rejected;
  };
  EXPECT_LE(too_low(values_for_log_variance(shape, z)), 120);
  EXPECT_GE(too_low(1000), 500);
}

}  // namespace
}  // namespace assay::stats
