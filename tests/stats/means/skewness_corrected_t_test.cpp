#include "stats/means/skewness_corrected_t.h"

#include "stats/basics/errors.h"
#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/calibration.h"
#include "tests/stats/laws.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

namespace laws = tests::laws;

// make_means.py, skewed.
Moments skewed(int k, int n) {
  Moments moments;
  for (int i = 1; i <= n; ++i) {
    moments.add(-std::log((i - .5) / n) * (1 + .2 * k * std::cos(.3 * k * i)));
  }
  return moments;
}

TEST(SkewnessCorrectedT, GoldenValueToThePrintedDigits) {
  const Moments x = moments_of(golden_x);
  // At this null value T from s equals the worked example's T from the deviation with denominator
  // n.
  const double null_value = x.mean + .742126210128256 * x.standard_error();
  EXPECT_NEAR(skewness_corrected_t(x, {null_value}).statistic, -.638855547353991, 1e-14);
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
    EXPECT_EQ(two.exactness, Exactness::asymptotic);
  }
}

TEST(SkewnessCorrectedT, ASymmetricSampleGivesStudentT) {
  const Moments x = moments_of(std::vector<double>{-2, -1, 0, 1, 2});
  const TestResult plain = student_t(x, {.7});
  const TestResult corrected = skewness_corrected_t(x, {.7});
  EXPECT_NEAR(corrected.statistic, plain.statistic, 1e-15);
  EXPECT_NEAR(corrected.log_p_lower, plain.log_p_lower, 1e-14);
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

TEST(SkewnessCorrectedT, DeepTailsStayFinite) {
  const Moments x = skewed(2, 4000);
  const TestResult result = skewness_corrected_t(x, {1e6});
  EXPECT_LT(result.log_p_lower, -700);
  EXPECT_TRUE(std::isfinite(result.log_p_lower));
}

TEST(SkewnessCorrectedT, BadArgumentsAreNamed) {
  const Moments x = moments_of(golden_x);
  const Moments constant = moments_of(std::vector<double>{1, 1, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(skewness_corrected_t(constant, {0}), ZeroVariance);
  EXPECT_THROW(skewness_corrected_t(x, {nan}), std::domain_error);
  EXPECT_THROW(skewness_corrected_t(x, {0, -1}), std::domain_error);
  EXPECT_THROW(skewness_corrected_welch(x, x, {1, nan}), std::domain_error);
  EXPECT_THROW(skewness_corrected_welch(constant, constant, {}), ZeroVariance);
  EXPECT_THROW(corrected_level_factor(x, {0}, 0), std::domain_error);
  EXPECT_NO_THROW(skewness_corrected_welch(x, constant, {}));
}

// ---- The remaining error

TEST(ResidualSkewness, AnExactReferenceSampleIsAConstantOne) {
  const Moments x = skewed(4, 300);
  const Moments constant = moments_of(std::vector<double>(10, 1.0));
  EXPECT_NEAR(corrected_level_factor(x, constant, 1, 3.1), corrected_level_factor(x, {1}, 3.1),
              1e-12);
}

TEST(ResidualSkewness, TheGateKnowsWhatIsTooSmallAndTooSkewed) {
  const Moments x = moments_of(golden_x);
  EXPECT_EQ(residual_skewness_gate(x, {1}, 3.1).state, GateState::red);
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
  double repetitions = 0;
  double lower_01 = 0, lower_001 = 0, upper_01 = 0, upper_001 = 0;

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
  void print(const char* name, std::size_t n) const {
    std::printf("  %s, n = %zu: %.4f %.5f lower, %.4f %.5f upper\n", name, n,
                lower_01 / repetitions, lower_001 / repetitions, upper_01 / repetitions,
                upper_001 / repetitions);
  }
};

template <class Test>
Levels levels(const Law& law, std::size_t n, std::uint32_t test_case, const Test& test,
              std::size_t most = 40000) {
  Philox random(test_case);
  Levels result;
  const std::size_t runs = std::min(most, 10000000 / n);
  for (std::size_t i = 0; i < runs; ++i) {
    result.add(test(draw_moments(law, n, random), law.mean));
  }
  return result;
}

TestResult corrected(const Moments& x, double mean) { return skewness_corrected_t(x, {mean}); }

struct Shape {
  double skewness = 0;
  double excess_kurtosis = 0;
};

struct Shaped {
  Law law;
  Shape shape;
};

/// The factor of `n` values of the population's own shape.
double factor_of(const Shape& shape, std::size_t n, double critical_value) {
  const double count = static_cast<double>(n);
  Moments x;
  x.count = n;
  x.m2 = count;
  x.m3 = count * shape.skewness;
  x.m4 = count * (shape.excess_kurtosis + 3);
  return corrected_level_factor(x, {0}, critical_value);
}

const std::vector<Shaped> shaped{
    {laws::normal, {0, 0}},
    {laws::exponential, {2, 6}},
    {laws::lognormal_half, {1.7502, 5.8984}},
    {laws::lognormal_one, {6.1849, 110.94}},
    {laws::t5, {0, 6}},
    {laws::uniform, {0, -1.2}},
    {laws::zero_inflated, {4.5}},
};

TEST(SkewnessCorrectedT, KeepsItsLevelWhereTheFactorSaysSo) {
  std::uint32_t test_case = 201;
  int checked = 0;
  for (Shaped each : shaped) {
    if (each.law.name == laws::zero_inflated.name) {
      // q = .2, exponential: raw moments .2, .4, 1.2, 4.8 and central ones by hand.
      const double v = .4 - .04;
      const double third = 1.2 - 3 * .2 * .4 + 2 * .008;
      const double fourth = 4.8 - 4 * .2 * 1.2 + 6 * .04 * .4 - 3 * .0016;
      each.shape = {third / (v * std::sqrt(v)), fourth / (v * v) - 3};
    }
    for (const std::size_t n : {50UL, 200UL, 1000UL}) {
      const bool at_01 = factor_of(each.shape, n, 2.326) <= 1.25;
      const bool at_001 = factor_of(each.shape, n, 3.090) <= 1.25;
      ++test_case;
      if (!at_01) continue;
      const Levels seen = levels(each.law, n, test_case, corrected,
                                 tests::repetitions(std::min<std::size_t>(40000, 10000000 / n)));
      seen.print(each.law.name, n);
      EXPECT_TRUE(seen.kept_01()) << each.law.name << " " << n;
      EXPECT_TRUE(!at_001 || seen.kept_001()) << each.law.name << " " << n;
      checked += 1 + at_001;
    }
  }
  // There are 42. A factor that refuses everything would prove nothing.
  EXPECT_GE(checked, 20);
}

TEST(SkewnessCorrectedT, TwoSamplesKeepTheirLevelToo) {
  Philox random(231);
  Levels seen;
  for (int i = 0; i < 40000; ++i) {
    const Moments x = draw_moments(laws::exponential, 400, random);
    const Moments y = draw_moments(laws::normal, 300, random);
    seen.add(skewness_corrected_welch(x, y, {.8, 1}));
  }
  seen.print("exponential less normal", 400);
  EXPECT_TRUE(seen.kept_01() && seen.kept_001());
}

TEST(SkewnessCorrectedT, IsUniformOnNormalValues) {
  const auto calibration = tests::calibrate({232}, [](Philox& random) {
    return log_p_two_sided(skewness_corrected_t(draw_moments(laws::normal, 100, random), {0}));
  });
  EXPECT_TRUE(calibration.ok) << calibration.text();
  std::printf("  %s\n", calibration.text().c_str());
}

// ---- Mutants

TEST(SkewnessCorrectedT, WithoutOrWithTheOppositeCorrectionTheLevelIsLost) {
  const auto plain = [](const Moments& x, double mean) { return student_t(x, {mean}); };
  const auto opposite = [](Moments x, double mean) {
    x.m3 = -x.m3;
    return skewness_corrected_t(x, {mean});
  };
  EXPECT_FALSE(levels(laws::exponential, 200, 241, plain).kept_01());
  EXPECT_FALSE(levels(laws::exponential, 200, 242, opposite).kept_01());
}

TEST(SkewnessCorrectedT, ASecondSampleAddedInsteadOfSubtractedIsNoticed) {
  Philox random(243);
  Levels seen;
  for (int i = 0; i < 40000; ++i) {
    const Moments x = draw_moments(laws::normal, 300, random);
    Moments y = draw_moments(laws::exponential, 200, random);
    y.m3 = -y.m3;
    seen.add(skewness_corrected_welch(x, y, {1, -1}));
  }
  EXPECT_FALSE(seen.kept_01() && seen.kept_001());
}

TEST(SkewnessCorrectedT, HallsNormalReferenceIsNoticedOnFiftyNormalValues) {
  const auto with_normal_law = [](const Moments& x, double mean) {
    TestResult result = skewness_corrected_t(x, {mean});
    const LogTails tails = normal_tails(result.statistic);
    result.log_p_lower = tails.lower;
    result.log_p_upper = tails.upper;
    return result;
  };
  EXPECT_FALSE(levels(laws::normal, 25, 244, with_normal_law).kept_001());
}

}  // namespace
}  // namespace assay::stats
