#include "stats/gates/assumption_gates.h"
#include "stats/variances/normal_variances.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

const Moments x = moments_of(golden_x);
const Moments y = moments_of(golden_y);
const Moments constant = moments_of(std::vector<double>{1, 1, 1, 1});

TEST(ChiSquareVariance, IntervalEndsAreJustRejected) {
  const Interval log = log_variance_evidence(x, {}, 1).interval(.98);
  EXPECT_NEAR(std::exp(chi_square_variance(x, std::exp(log.low)).log_p_upper), .01, 1e-12);
  EXPECT_NEAR(std::exp(chi_square_variance(x, std::exp(log.high)).log_p_lower), .01, 1e-12);
}

TEST(FRatio, IntervalEndsAreJustRejected) {
  const Interval log = log_variance_evidence(x, y, 1).interval(.98);
  EXPECT_NEAR(std::exp(f_ratio(x, y, std::exp(log.low)).log_p_upper), .01, 1e-12);
  EXPECT_NEAR(std::exp(f_ratio(x, y, std::exp(log.high)).log_p_lower), .01, 1e-12);
}

// Sums of `shape` exponential values: excess kurtosis 6 / shape.
Moments gamma_moments(int shape, std::size_t count, Philox& random) {
  return draw_moments(count, [&] {
    double product = 1;
    for (int i = 0; i < shape; ++i) product *= random.uniform();
    return -std::log(product);
  });
}

// In 95 % of normal samples the limit is above the law's kurtosis, in some 90 % of skewed ones, and
// seldom far above. False alarms: 2.5e-6.
TEST(Variances, TheUpperLimitOfAKurtosisHoldsIt) {
  constexpr double runs = 2000;
  Philox random(1811);
  double normal_missed = 0, gamma_missed = 0, beyond = 0;
  for (int run = 0; run < runs; ++run) {
    const auto normal = draw_moments(512, [&] { return random.normal(); });
    normal_missed += kurtosis_upper_limit(normal) <= 0;
    beyond += kurtosis_upper_limit(normal) > 1.5;
    gamma_missed += kurtosis_upper_limit(gamma_moments(12, 512, random)) < .5;
  }
  EXPECT_FALSE(tests::too_many(normal_missed / runs, .07, runs)) << normal_missed;
  EXPECT_FALSE(tests::too_many(gamma_missed / runs, .2, runs)) << gamma_missed;
  EXPECT_FALSE(tests::too_many(beyond / runs, .05, runs)) << beyond;
}

}  // namespace
}  // namespace assay::stats
