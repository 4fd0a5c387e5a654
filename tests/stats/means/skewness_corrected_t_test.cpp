#include "stats/means/skewness_corrected_t.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// make_means.py, skewed.
Moments skewed(int k, int n) {
  Moments moments;
  for (int i = 1; i <= n; ++i) {
    moments.add(-std::log((i - .5) / n) * (1 + .2 * k * std::cos(.3 * k * i)));
  }
  return moments;
}

TEST(SkewnessCorrectedT, AgreesWithInfluenceValuesTakenOneByOne) {
  for (const Row& row : tests::read_table("skewness_corrected_t")) {
    const int k = static_cast<int>(row["k"]);
    SCOPED_TRACE(k);
    const Moments x = skewed(k, 20 * k);
    const Moments y = skewed(k + 2, 15 * k);
    const TestResult one = skewness_corrected_t(x, {row["null"], row["error"]});
    EXPECT_NEAR(one.statistic / row["one"], 1, 1e-10);
    EXPECT_NEAR(one.log_p_lower / row["one_lower"], 1, 1e-9);
    EXPECT_NEAR(one.log_p_upper / row["one_upper"], 1, 1e-9);
    const TestResult two = skewness_corrected_welch(x, y, {row["scale"], row["offset"]});
    EXPECT_NEAR(two.statistic / row["two"], 1, 1e-10);
    EXPECT_NEAR(two.log_p_lower / row["two_lower"], 1, 1e-9);
    EXPECT_NEAR(two.log_p_upper / row["two_upper"], 1, 1e-9);
  }
}

TEST(SkewnessCorrectedT, TheStatisticFallsWithTheNullValueThroughTheFlatPoint) {
  const Moments x = skewed(1, 25);
  double previous = std::numeric_limits<double>::infinity();
  for (double null_value = -20; null_value < 20; null_value += .01) {
    const double statistic = skewness_corrected_t(x, {null_value}).statistic;
    EXPECT_LE(statistic, previous + 1e-12 * std::abs(statistic)) << null_value;
    previous = statistic;
  }
}

// ---- The remaining error

TEST(ResidualSkewness, AnExactReferenceSampleIsAConstantOne) {
  const Moments x = skewed(4, 300);
  const Moments constant = moments_of(std::vector<double>(10, 1.0));
  EXPECT_NEAR(residual_skewness_gate(x, constant, 1, 3.1).value,
              residual_skewness_gate(x, {1}, 3.1).value, 1e-12);
}

TEST(ResidualSkewness, TheGateKnowsWhatIsTooSmallAndTooSkewed) {
  EXPECT_GT(residual_skewness_gate(skewed(1, 25), {1}, 3.1).value, 2);
  EXPECT_EQ(residual_skewness_gate(skewed(1, 2000), {1}, 3.1).state, GateState::green);
  EXPECT_EQ(residual_skewness_gate(skewed(1, 2000), skewed(2, 1000), 1, 3.1).state,
            GateState::green);
  Moments rare;
  for (int i = 0; i < 3000; ++i) rare.add(i % 1000 == 0);
  EXPECT_EQ(residual_skewness_gate(rare, {.001}, 3.1).state, GateState::red);
}

// ---- Level. Where the population's factor is at most 1.25 at the level's critical value, each
// tail is at most 1.25 times nominal. Each comparison raises a false alarm with probability 2.5e-6
// (Chernoff). Seed 1, streams 201 and on.

struct Levels {
  double repetitions = 0, lower_01 = 0, lower_001 = 0, upper_01 = 0, upper_001 = 0;

  void add(const TestResult& result) {
    repetitions += 1;
    lower_01 += result.log_p_lower <= std::log(.01);
    lower_001 += result.log_p_lower <= std::log(.001);
    upper_01 += result.log_p_upper <= std::log(.01);
    upper_001 += result.log_p_upper <= std::log(.001);
  }
  bool above(double hits, double level) const {
    return tests::too_many(hits / repetitions, 1.25 * level, repetitions);
  }
  bool kept_01() const { return !above(lower_01, .01) && !above(upper_01, .01); }
  bool kept_001() const { return !above(lower_001, .001) && !above(upper_001, .001); }
};

Levels levels(std::uint32_t test_case, std::size_t runs,
              const std::function<TestResult(Philox&)>& draw) {
  Philox random(test_case);
  Levels result;
  for (std::size_t i = 0; i < runs; ++i) result.add(draw(random));
  std::cout << "  of " << runs << " at .01, .001: " << result.lower_01 << ", " << result.lower_001
            << " lower, " << result.upper_01 << ", " << result.upper_001 << " upper\n";
  return result;
}

struct ShapedLaw {
  Law law;
  double skewness = 0, excess_kurtosis = 0;
};

/// The factor of `n` values of the population's own shape.
double factor_of(const ShapedLaw& shape, std::size_t n, double critical_value) {
  const double count = static_cast<double>(n);
  const double m4 = count * (shape.excess_kurtosis + 3);
  const Moments x{.count = n, .m2 = count, .m3 = count * shape.skewness, .m4 = m4};
  return residual_skewness_gate(x, {0}, critical_value).value;
}

const std::vector<ShapedLaw> shaped{
    {laws::normal, 0, 0},
    {laws::exponential, 2, 6},
    {laws::lognormal_half, 1.7502, 5.8984},
    {laws::lognormal_one, 6.1849, 110.94},
    {laws::t5, 0, 6},
    {laws::uniform, 0, -1.2},
    // Raw moments .2, .4, 1.2, 4.8; central ones .36, .976, 3.9312.
    {laws::zero_inflated, .976 / (.36 * .6), 3.9312 / (.36 * .36) - 3},
};

TEST(SkewnessCorrectedT, KeepsItsLevelWhereTheFactorSaysSo) {
  std::uint32_t test_case = 201;
  int checked = 0;
  for (const ShapedLaw& each : shaped) {
    for (const std::size_t n : {50UL, 200UL, 1000UL}) {
      const bool at_01 = factor_of(each, n, 2.326) <= 1.25;
      const bool at_001 = factor_of(each, n, 3.090) <= 1.25;
      ++test_case;
      if (!at_01) continue;
      std::cout << "  " << each.law.name << ", n = " << n << "\n";
      const std::size_t runs = tests::repetitions(std::min<std::size_t>(40000, 10000000 / n));
      const Levels seen = levels(test_case, runs, [&](Philox& random) {
        return skewness_corrected_t(draw_moments(each.law, n, random), {each.law.mean});
      });
      EXPECT_TRUE(seen.kept_01()) << each.law.name << " " << n;
      EXPECT_TRUE(!at_001 || seen.kept_001()) << each.law.name << " " << n;
      checked += 1 + at_001;
    }
  }
  // There are 42. A factor that refuses everything would prove nothing.
  EXPECT_GE(checked, 20);
}

TEST(SkewnessCorrectedT, TwoSamplesKeepTheirLevelToo) {
  const Levels seen = levels(231, 40000, [](Philox& random) {
    const Moments x = draw_moments(laws::exponential, 400, random);
    return skewness_corrected_welch(x, draw_moments(laws::normal, 300, random), {.8, 1});
  });
  EXPECT_TRUE(seen.kept_01() && seen.kept_001());
}

CALIBRATED(SkewnessCorrectedT, IsUniformOnNormalValues, 232) {
  return log_p_two_sided(skewness_corrected_t(draw_moments(laws::normal, 100, random), {0}));
}

// ---- Mutants

TEST(SkewnessCorrectedT, WithoutOrWithTheOppositeCorrectionTheLevelIsLost) {
  const auto plain = [](Philox& random) {
    return student_t(draw_moments(laws::exponential, 200, random), {1});
  };
  const auto opposite = [](Philox& random) {
    Moments x = draw_moments(laws::exponential, 200, random);
    x.m3 = -x.m3;
    return skewness_corrected_t(x, {1});
  };
  EXPECT_FALSE(levels(241, 40000, plain).kept_01());
  EXPECT_FALSE(levels(242, 40000, opposite).kept_01());
}

TEST(SkewnessCorrectedT, ASecondSampleAddedInsteadOfSubtractedIsNoticed) {
  const Levels seen = levels(243, 40000, [](Philox& random) {
    const Moments x = draw_moments(laws::normal, 300, random);
    Moments y = draw_moments(laws::exponential, 100, random);
    y.m3 = -y.m3;
    return skewness_corrected_welch(x, y, {1, -1});
  });
  EXPECT_FALSE(seen.kept_01() && seen.kept_001());
}

TEST(SkewnessCorrectedT, ANormalReferenceIsNoticedOnFifteenNormalValues) {
  const Levels seen = levels(244, 40000, [](Philox& random) {
    const double h = skewness_corrected_t(draw_moments(laws::normal, 15, random), {0}).statistic;
    return by_tails(h, {}, normal_tails(h));
  });
  EXPECT_FALSE(seen.kept_001());
}

}  // namespace
}  // namespace assay::stats
