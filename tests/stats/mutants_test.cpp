// Each method is broken in one known way, and the calibration of tests/stats/calibration.h must
// notice. With these repetitions every one misses by at least twice the threshold in expectation.

#include "stats/cells/chi_square.h"
#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/means/student_t.h"
#include "stats/tails/kolmogorov.h"
#include "stats/tails/tails.h"
#include "stats/tails/test_result.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

CAUGHT(Mutants, StudentTFromTheNormalLawIsCaught, 103, 20000) {
  const Moments x = normal_moments(random, 7);
  return log_p_two_sided(normal_tails(x.mean / x.standard_error()));
}

CAUGHT(Mutants, AOneSidedTailDoubledIsCaught, 104) {
  return std::min(0.0, std::numbers::ln2 + student_t(normal_moments(random, 7), {0}).log_p_upper);
}

CAUGHT(Mutants, AReferenceErrorIgnoredIsCaught, 106) {
  const Moments x = normal_moments(random, 30);
  return log_p_two_sided(student_t(x, {.2 * random.normal()}));
}

CAUGHT(Mutants, PooledVarianceOfUnequalSamplesIsCaught, 107) {
  const Moments x = normal_moments(random, 10, 1.8);
  const Moments y = normal_moments(random, 100);
  const double pooled = (x.m2 + y.m2) / 108;
  return log_p_two_sided(
      student_t_tails((x.mean - y.mean) / std::sqrt(pooled * (1 / 10.0 + 1 / 100.0)), 108));
}

CAUGHT(Mutants, AContrastWhoseScaleIsNotSquaredIsCaught, 108) {
  const Moments x = draw_moments(40, [&] { return 10 + random.normal(); });
  const Moments y = draw_moments(20, [&] { return 5 + random.normal(); });
  const double se = std::sqrt(x.variance() / 40 + 2 * y.variance() / 20);
  return log_p_two_sided(student_t_tails((x.mean - 2 * y.mean) / se, 35));
}

CAUGHT(Mutants, ChiSquareWithNDegreesOfFreedomIsCaught, 109, 20000) {
  return chi_square_tails(normal_moments(random, 6).m2, 6).upper;
}

CAUGHT(Mutants, FWithExchangedDegreesOfFreedomIsCaught, 111, 20000) {
  const Moments x = normal_moments(random, 4);
  const Moments y = normal_moments(random, 20);
  return f_tails(x.variance() / y.variance(), {19, 3}).upper;
}

CAUGHT(Mutants, AsymptoticKolmogorovSmirnovOnFewValuesIsCaught, 115, 20000) {
  const auto values = sorted(sample_of(6, [&] { return random.uniform(); }));
  const ContinuousLaw uniform{[](double u) { return u; }};
  return log_kolmogorov_limit(std::sqrt(6) * ks_distance(values, uniform).distance);
}

CAUGHT(Mutants, KolmogorovSmirnovFromOneSideOnlyIsCaught, 116) {
  const auto values = sorted(sample_of(20, [&] { return random.uniform(); }));
  double d = 0;
  for (std::size_t i = 0; i < 20; ++i)
    d = std::max(d, (static_cast<double>(i) + 1) / 20 - values[i]);
  return kolmogorov_tails(std::clamp(d, 0.0, 1.0), 20).upper;
}

CAUGHT(Mutants, KolmogorovSmirnovWithAFittedMeanIsCaught, 117) {
  auto values = sorted(sample_of(30, [&] { return random.normal(); }));
  const double mean = tests::moments_of(values).mean;
  const ContinuousLaw fitted{[&](double v) { return std::exp(normal_tails(v - mean).lower); }};
  return kolmogorov_smirnov(ks_distance(values, fitted)).log_p_upper;
}

CAUGHT(Mutants, TiesWalkedOneAtATimeAreCaught, 118, 20000, Shape::at_most_uniform) {
  const auto x = sorted(sample_of(40, [&] { return std::max(0.0, random.normal()); }));
  const auto y = sorted(sample_of(40, [&] { return std::max(0.0, random.normal()); }));
  std::size_t i = 0;
  std::size_t j = 0;
  std::int64_t largest = 0;
  while (i < 40 && j < 40) {
    (x[i] <= y[j] ? i : j) += 1;
    largest =
        std::max(largest, std::abs(static_cast<std::int64_t>(i) - static_cast<std::int64_t>(j)));
  }
  return smirnov_upper_tail({static_cast<std::uint64_t>(largest), 40, 40});
}

CAUGHT(Mutants, AChiSquareFitThatCountsEveryCellAsADegreeOfFreedomIsCaught, 119, 20000) {
  const std::vector<double> flat(5, .2);
  const ChiSquareFit fit = chi_square_fit({multinomial(random, 200, flat), flat});
  return chi_square_tails(fit.test.statistic, 5).upper;
}

CAUGHT(Mutants, ABinomialTailWithoutItsOwnCountIsCaught, 120, 20000, Shape::at_most_uniform) {
  std::uint64_t hits = 0;
  for (int i = 0; i < 50; ++i) hits += random.uniform() < .07;
  return binomial_tails(hits + 1, {50, .07}).upper;
}

CAUGHT(Mutants, EquivalenceByTheSmallerOfTwoPValuesIsCaught, 121, 20000, Shape::at_most_uniform) {
  const Moments x = draw_moments(60, [&] { return .5 + random.normal(); });
  return std::min(student_t(x, {-.5}).log_p_upper, student_t(x, {.5}).log_p_lower);
}

CAUGHT(Mutants, MultiplicityIgnoredIsCaught, 122, 20000, Shape::at_most_uniform) {
  double smallest = 0;
  for (int i = 0; i < 20; ++i) smallest = std::min(smallest, std::log(random.uniform()));
  return smallest;
}

CAUGHT(Mutants, CorrelatedStepsTakenAsIndependentAreCaught, 123, 5000) {
  double state = random.normal();
  const Moments chain = draw_moments(200, [&] {
    state = .9 * state + std::sqrt(1 - .81) * random.normal();
    return state;
  });
  return log_p_two_sided(student_t(chain, {0}));
}

}  // namespace
}  // namespace assay::stats
