// Predicted power against simulated rejections. Hoeffding's bound gives a false-alarm rate of 1e-5
// each. |rate - power| <= sqrt(ln(2e5) / (2 R)), .0247 at R = 10000, .0391 at R = 4000.

#include "stats/cells/chi_square.h"
#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/means/student_t.h"
#include "stats/planning/power.h"
#include "stats/tails/test_result.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

double rate_of(std::uint32_t test_case, int repetitions,
               const std::function<double(Philox&)>& draw) {
  Philox random(test_case);
  int rejected = 0;
  for (int i = 0; i < repetitions; ++i) rejected += draw(random) <= std::log(.01);
  return rejected / static_cast<double>(repetitions);
}

double bound(int repetitions) { return std::sqrt(std::log(2e5) / (2.0 * repetitions)); }

const ErrorRates usual_rates{.01, .2, true};

TEST(PowerSimulation, StudentTPlannedForAnEffectFindsItAsOftenAsPredicted) {
  const MeanPlan plan{.rates = usual_rates};
  const auto n = student_t_sample_size(plan, .5).value();
  const double rate = rate_of(201, 10000, [&](Philox& random) {
    return log_p_two_sided(student_t(draw_moments(n, [&] { return .5 + random.normal(); }), {0}));
  });
  EXPECT_NEAR(rate, student_t_power(plan, static_cast<double>(n), .5), bound(10000));
  EXPECT_GE(rate, .8 - bound(10000));
}

TEST(PowerSimulation, AnAllowedEffectIsSubtractedOnBothSides) {
  const MeanPlan plan{.allow = .2, .rates = usual_rates};
  const double rate = rate_of(202, 10000, [&](Philox& random) {
    const Moments x = draw_moments(60, [&] { return -.6 + random.normal(); });
    return std::min(0.0, std::log(2) + std::min(student_t(x, {.2}).log_p_upper,
                                                student_t(x, {-.2}).log_p_lower));
  });
  EXPECT_NEAR(rate, student_t_power(plan, 60, .6), bound(10000));
}

TEST(PowerSimulation, AReferenceErrorCostsPowerAsPredicted) {
  const MeanPlan plan{.reference_standard_error = .1, .rates = usual_rates};
  const double rate = rate_of(203, 10000, [&](Philox& random) {
    const Moments x = draw_moments(80, [&] { return .5 + random.normal(); });
    return log_p_two_sided(student_t(x, {.1 * random.normal(), .1}));
  });
  EXPECT_NEAR(rate, student_t_power(plan, 80, .5), bound(10000));
}

// Without its skewness the plan misses one downwards nine times too often.
TEST(PowerSimulation, AnEffectOnSkewedValuesIsFoundOnEitherSide) {
  for (const int side : {1, -1}) {
    const auto found = [&](double effect) {
      return rate_of(211, 10000, [&](Philox& random) {
        const Moments x = draw_moments(150, [&] { return effect + random.exponential(); });
        return log_p_two_sided(skewness_corrected_t(x, {1}));
      });
    };
    const double size = side * student_t_detectable({.skewness = 2.0 * side}, 150);
    EXPECT_GE(found(size), .99 - bound(10000)) << side;
    EXPECT_LT(found(.7 * size), .99 - bound(10000)) << side;
  }
}

TEST(PowerSimulation, WelchWithUnequalVariances) {
  const MeanPlan plan{.other_standard_deviation = 2, .allocation = 2, .rates = usual_rates};
  const auto n = student_t_sample_size(plan, 1).value();
  const double rate = rate_of(204, 10000, [&](Philox& random) {
    const Moments x = draw_moments(n, [&] { return 1 + random.normal(); });
    const Moments y = draw_moments(2 * n, [&] { return 2 * random.normal(); });
    return log_p_two_sided(welch_t(x, y, {}));
  });
  EXPECT_NEAR(rate, student_t_power(plan, static_cast<double>(n), 1), bound(10000));
}

TEST(PowerSimulation, KolmogorovSmirnovReachesItsBound) {
  const DistancePlan plan{.rates = {.01, .2, true}};
  const auto n = ks_sample_size(plan, .15).value();
  const ContinuousLaw uniform{[](double u) { return u; }};
  // Mass .15 moved from above one half to below: sup distance .15 exactly.
  const double rate = rate_of(208, 4000, [&](Philox& random) {
    const auto values = sorted(sample_of(n, [&] {
      const double u = random.uniform();
      return u < .65 ? u / 1.3 : .5 + (u - .65) / .7;
    }));
    return kolmogorov_smirnov(ks_distance(values, uniform)).log_p_upper;
  });
  EXPECT_GE(rate, .8 - bound(4000));
}

// The exact probability that two samples of n differ by at least `steps` / n. Their laws on {0, 1}
// differ by `distance` at 0, the hardest case of that distance.
double probability_of_steps(std::uint64_t steps, std::uint64_t n, double distance) {
  std::vector<double> one, other;
  for (std::uint64_t k = 0; k <= n; ++k) {
    one.push_back(binomial_mass(k, n, .5 + distance / 2));
    other.push_back(binomial_mass(k, n, .5 - distance / 2));
  }
  double sum = 0;
  for (std::uint64_t k = 0; k <= n; ++k) {
    for (std::uint64_t l = 0; l <= n; ++l) {
      if ((k > l ? k - l : l - k) >= steps) sum += one[k] * other[l];
    }
  }
  return sum;
}

// The least number of steps that the test itself rejects.
std::uint64_t rejected_steps(const DistancePlan& plan, std::uint64_t n) {
  std::uint64_t steps = 0;
  for (;; ++steps) {
    const TwoSampleDistance seen{.lattice = {steps, n, n}};
    const TestResult result =
        plan.allow == 0 ? kolmogorov_smirnov(seen) : ks_margin(seen, plan.allow);
    if (result.log_p_upper <= std::log(plan.rates.alpha)) return steps;
  }
}

TEST(PowerSimulation, TwoSampleKolmogorovSmirnovKeepsWhatItPromises) {
  for (const double beta : {.01, .001}) {
    for (const double allow : {0.0, .1}) {
      const DistancePlan plan{.two_samples = true, .allow = allow, .rates = {.01, beta, true}};
      const auto n = ks_sample_size(plan, allow + .25).value();
      EXPECT_GE(probability_of_steps(rejected_steps(plan, n), n, allow + .25), 1 - beta)
          << allow << " " << beta << " n = " << n;
    }
  }
}

// The detectable distance is the test's own critical distance and Hoeffding's sqrt(ln(1/beta) / n).
// With a margin the critical distance is no lattice point, and the test lies within a step of it.
TEST(PowerSimulation, TwoSampleKolmogorovSmirnovIsPlannedForItsOwnCriticalDistance) {
  for (const double allow : {0.0, .1}) {
    const DistancePlan plan{.two_samples = true, .allow = allow, .rates = {.01, .05, true}};
    const double n = 400;
    const double critical = ks_detectable(plan, n) - std::sqrt(std::log(1 / .05) / n);
    const double of_test = static_cast<double>(rejected_steps(plan, 400)) / n;
    EXPECT_LE(critical, of_test + 1e-9) << allow;
    EXPECT_GT(critical, of_test - 1 / n - 1e-9) << allow;
    EXPECT_NEAR(critical, of_test, allow == 0 ? 1e-12 : 1 / n + 1e-9);
  }
}

TEST(PowerSimulation, ChiSquareFit) {
  const std::vector<double> flat(10, .1);
  std::vector<double> slight = flat;
  slight[0] += .02;
  slight[1] -= .02;
  const double effect = std::sqrt(2 * .02 * .02 / .1);
  const FitPlan plan{.degrees_of_freedom = 9, .rates = {.01, .2, false}};
  const auto n = chi_square_fit_sample_size(plan, effect).value();
  const double rate = rate_of(209, 4000, [&](Philox& random) {
    return chi_square_fit({multinomial(random, n, slight), flat}).test.log_p_upper;
  });
  EXPECT_NEAR(rate, chi_square_fit_power(plan, static_cast<double>(n), effect), bound(4000));
}

// Two one-sided tests miss a mean of 0 at either margin.
TEST(PowerSimulation, EquivalenceMissesTwiceAsOftenAsOneMargin) {
  constexpr std::size_t n = 60;
  const double rate = rate_of(210, 10000, [&](Philox& random) {
    const Moments x = draw_moments(n, [&] { return random.normal(); });
    return log_p_equivalence(student_t(x, {-.5}), student_t(x, {.5}));
  });
  EXPECT_NEAR(rate, 2 * student_t_power({.rates = {.01, .2, false}}, n, .5) - 1, bound(10000));
}

}  // namespace
}  // namespace assay::stats
