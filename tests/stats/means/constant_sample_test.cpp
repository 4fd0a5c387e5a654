#include "stats/means/constant_sample.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(ConstantSample, RareValuesOfAnExactMeanAreBinomial) {
  // 0.05 above 0 in [0, 0.1] needs a half of the values at 0.1 or more: (1/2)^10.
  EXPECT_NEAR(log_p_constant({0, 0, 0.1, 10}, {0.05, 0}), -10 * std::log(2.0), 1e-13);
  // A fifth of the way down to the lower end.
  EXPECT_NEAR(log_p_constant({3, 1, 7, 64}, {2.6, 0}), 64 * std::log(0.8), 1e-12);
}

TEST(ConstantSample, WithoutARangeNothingIsRefuted) {
  EXPECT_EQ(log_p_constant({0.02, 0, infinity, 1000}, {0.5, 0}), 0);
  EXPECT_EQ(log_p_constant({0.02, 0, infinity, 1000}, {0.5, 1e-9}), 0);
  EXPECT_LT(log_p_constant({0.02, 0, infinity, 1000}, {0.01, 1e-9}), std::log(1e-200));
}

TEST(ConstantSample, BeyondTheRangeNothingButTheReferencesErrorCanBeMeant) {
  EXPECT_EQ(log_p_constant({1, 0, 1, 5}, {2, 0}), std::numeric_limits<double>::lowest());
  EXPECT_NEAR(log_p_constant({1, 0, 1, 5}, {2, 0.5}), std::log(2.0) + normal_tails(2).upper, 1e-12);
  EXPECT_EQ(log_p_constant({1, 0, 1, 5}, {1, 0}), 0);
}

// The error of a quadrature, 1e-16, must not turn a pixel that was never lit into a certainty.
TEST(ConstantSample, ATinyErrorChangesNothing) {
  const ConstantSample dark{0.02, 0, 8, 64};
  const double exact = log_p_constant(dark, {0.025, 0});
  EXPECT_NEAR(exact, 64 * std::log1p(-0.005 / 7.98), 1e-12);
  EXPECT_NEAR(log_p_constant(dark, {0.025, 1e-16}), exact, 1e-9);
  EXPECT_NEAR(log_p_constant(dark, {0.025, 1e-9}), exact, 1e-6);
}

TEST(ConstantSample, TheErrorTakesTheGreatestOfAllDivisions) {
  for (const double error : {0.001, 0.01, 0.1, 1.0}) {
    const ConstantSample sample{0, 0, 1, 50};
    double most = -infinity;
    for (int i = 0; i <= 100000; ++i) {
      const double shift = 0.2 * i / 100000;
      const double both = 50 * std::log1p(-shift) +
                          std::min(0.0, std::log(2.0) + normal_tails((0.2 - shift) / error).upper);
      most = std::max(most, both);
    }
    EXPECT_NEAR(log_p_constant(sample, {0.2, error}), most, 1e-6) << error;
  }
}

TEST(ConstantSample, TwoMayBothHaveMissedValues) {
  const ConstantSample a{0, -1, 2, 16}, b{2, .5, 2, 24};
  double most = -infinity;
  for (int i = 0; i <= 100000; ++i) {
    const double s = .5 + 1.5 * i / 100000;
    most = std::max(most, 16 * std::log1p(-s / 2) + 24 * std::log1p(-(2 - s) / 1.5));
  }
  EXPECT_NEAR(log_p_constants(a, b), most, 1e-6);
  EXPECT_NEAR(log_p_constants(b, a), most, 1e-6);
  EXPECT_EQ(log_p_constants(a, {2, 2, 2, 1}), std::numeric_limits<double>::lowest());
  EXPECT_NEAR(log_p_constants(a, {1, 1, 1, 1}), 16 * std::log(.5), 1e-9);
}

TEST(ConstantSample, OtherValuesCountByTheirSizeForOneThatWasMissed) {
  const Moments others = moments_of(std::vector{2.0, 2.0, 3.0, 5.0});
  EXPECT_NEAR(size_about(2, others), std::sqrt((1.0 + 81) / (1 + 9)), 1e-12);
  EXPECT_EQ(size_about(0.1F, moments_of(std::vector<double>(9, 0.1F))), infinity);
}

}  // namespace
}  // namespace assay::stats
