// Every p-value under its own null hypothesis. False-alarm rate of each test: 1e-5
// (tests/stats/calibration.h). The seed is 1, and streams are numbered in order of writing.

#include "stats/cells/chi_square.h"
#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/means/binomial.h"
#include "stats/means/student_t.h"
#include "stats/planning/holm.h"
#include "stats/tails/test_result.h"
#include "stats/variances/normal_variances.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

CALIBRATED(Calibration, StudentTOnThreeNormalValuesIsUniform, 1, 40000) {
  return log_p_two_sided(student_t(normal_moments(random, 3), {0}));
}

TAILS_CALIBRATED(Calibration, BothTailsOfStudentTAreUniform, 2) {
  return student_t(normal_moments(random, 7), {0});
}

CALIBRATED(Calibration, StudentTAgainstANoisyReferenceIsUniform, 4) {
  const Moments x = normal_moments(random, 30);
  return log_p_two_sided(student_t(x, {.2 * random.normal(), .2}));
}

CALIBRATED(Calibration, WelchWithUnequalSizesAndVariancesIsUniform, 5, 40000) {
  const Moments x = normal_moments(random, 10, 1.8);
  return log_p_two_sided(welch_t(x, normal_moments(random, 100), {}));
}

CALIBRATED(Calibration, AWelchContrastIsUniformAtItsOwnNull, 6) {
  const Moments x = draw_moments(40, [&] { return 5.5 + 2 * random.normal(); });
  const Moments y = draw_moments(20, [&] { return 5 + random.normal(); });
  return welch_t(x, y, {1.1, 0}).log_p_upper;
}

TEST(Calibration, ChiSquareVarianceOnThreeNormalValuesIsUniform) {
  expect_calibrated({7, 40000}, [](Philox& random) {
    return chi_square_variance(normal_moments(random, 3, 2), 4).log_p_upper;
  });
  expect_calibrated({8}, [](Philox& random) {
    return log_p_two_sided(chi_square_variance(normal_moments(random, 12), 1));
  });
}

TEST(Calibration, FRatioOnNormalValuesIsUniform) {
  expect_calibrated({9, 40000}, [](Philox& random) {
    const Moments x = normal_moments(random, 4, 3);
    return log_p_two_sided(f_ratio(x, normal_moments(random, 9), 9));
  });
  expect_calibrated({10}, [](Philox& random) {
    const Moments x = normal_moments(random, 20);
    return f_ratio(x, normal_moments(random, 5), 1).log_p_upper;
  });
}

TEST(Calibration, OneSampleKolmogorovSmirnovIsUniform) {
  const ContinuousLaw uniform{[](double u) { return u; }};
  std::uint32_t test_case = 14;
  for (const std::size_t n : {std::size_t{1}, std::size_t{6}, std::size_t{40}, std::size_t{200}}) {
    expect_calibrated({test_case++, n > 100 ? 4000UL : 20000UL}, [&](Philox& random) {
      const auto values = sorted(sample_of(n, [&] { return random.uniform(); }));
      return kolmogorov_smirnov(ks_distance(values, uniform)).log_p_upper;
    });
  }
}

TEST(Calibration, TwoSampleKolmogorovSmirnovIsAtMostUniformWithAndWithoutTies) {
  const auto calibrated = [](std::uint32_t test_case, std::size_t m, std::size_t n, double least) {
    expect_calibrated({test_case, 20000, Shape::at_most_uniform}, [&](Philox& random) {
      const auto draw = [&] { return std::max(least, random.normal()); };
      const auto x = sorted(sample_of(m, draw));
      return kolmogorov_smirnov(ks_distance(x, sorted(sample_of(n, draw)))).log_p_upper;
    });
  };
  calibrated(19, 13, 20, -100);
  calibrated(20, 50, 50, -100);
  calibrated(21, 30, 40, 0);
}

TEST(Calibration, KolmogorovSmirnovMarginsHoldAtTheirOwnNull) {
  // F(u) = u^1.4 against the uniform law: the largest distance in closed form.
  const double at = std::pow(1.4, -1 / .4);
  const double distance = at - std::pow(at, 1.4);
  const ContinuousLaw uniform{[](double u) { return u; }};
  const auto powers = [](Philox& random) {
    return sorted(sample_of(200, [&] { return std::pow(random.uniform(), 1 / 1.4); }));
  };
  expect_tails_calibrated({22, 4000, Shape::at_most_uniform}, [&](Philox& random) {
    return ks_margin(ks_distance(powers(random), uniform), distance);
  });
  expect_tails_calibrated({24, 2000, Shape::at_most_uniform}, [&](Philox& random) {
    const auto x = powers(random);
    const auto y = sorted(sample_of(300, [&] { return random.uniform(); }));
    return ks_margin(ks_distance(x, y), distance);
  });
}

// Counts of n draws from a discrete law by its cumulative probabilities.
const std::vector<double> uneven{.02, .05, .08, .1, .15, .2, .1, .1, .1, .1};

CALIBRATED(Calibration, ChiSquareFitIsUniform, 26, 5000) {
  return chi_square_fit({multinomial(random, 2000, uneven), uneven}).test.log_p_upper;
}

TEST(Calibration, ChiSquareFitEffectIsUniformAtItsOwnNull) {
  std::vector<double> slight = uneven;
  slight[5] += .03;
  slight[6] -= .03;
  const double effect = std::sqrt(.03 * .03 / .2 + .03 * .03 / .1);
  expect_calibrated({27, 4000}, [&](Philox& random) {
    const auto fit = chi_square_fit({multinomial(random, 4000, slight), uneven});
    return chi_square_fit_effect(fit, effect).log_p_upper;
  });
}

TAILS_CALIBRATED(Calibration, BinomialTailsAreAtMostUniform, 28, 20000, Shape::at_most_uniform) {
  std::uint64_t hits = 0;
  for (int i = 0; i < 50; ++i) hits += random.uniform() < .07;
  return binomial({hits, 50}, .07);
}

TEST(Calibration, EquivalenceAtItsMarginIsAtMostUniform) {
  expect_calibrated({30, 20000, Shape::at_most_uniform}, [](Philox& random) {
    const Moments x = draw_moments(60, [&] { return .5 + random.normal(); });
    return log_p_equivalence(student_t(x, {-.5}), student_t(x, {.5}));
  });
  expect_calibrated({31, 20000, Shape::at_most_uniform}, [](Philox& random) {
    const Moments x = draw_moments(40, [&] { return 11 + random.normal(); });
    const Moments y = draw_moments(25, [&] { return 10 + 2 * random.normal(); });
    return log_p_equivalence(welch_t(x, y, {.9, 0}), welch_t(x, y, {1.1, 0}));
  });
}

TEST(Calibration, TheSmallestHolmAdjustedValueOfAFamilyIsAtMostUniform) {
  expect_calibrated({32, 20000, Shape::at_most_uniform}, [](Philox& random) {
    std::vector<WeightedLogP> entries;
    for (int i = 0; i < 20; ++i) entries.push_back({std::log(random.uniform()), 1.0 / 20});
    const auto adjusted = weighted_holm(entries);
    return *std::min_element(adjusted.begin(), adjusted.end());
  });
  expect_calibrated({33, 20000, Shape::at_most_uniform}, [](Philox& random) {
    std::vector<WeightedLogP> entries;
    for (int i = 0; i < 9; ++i) entries.push_back({std::log(random.uniform()), (i + 1) / 45.0});
    const auto adjusted = weighted_holm(entries);
    return *std::min_element(adjusted.begin(), adjusted.end());
  });
}

}  // namespace
}  // namespace assay::stats
