#include "stats/cells/chi_square.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

CellCounts golden() {
  CellCounts counts{{18, 25, 31, 22, 14, 10}, {20, 24, 30, 24, 12, 10}};
  for (double& p : counts.probability) p /= 120;
  return counts;
}

TEST(ChiSquareFit, GoldenValuesToThePrintedDigits) {
  const ChiSquareFit fit = chi_square_fit(golden(), {.minimum_expected = 5});
  EXPECT_NEAR(fit.test.statistic, .775, 1e-12);
  EXPECT_NEAR(std::exp(fit.test.log_p_upper), .97860044, 5e-9);
  EXPECT_EQ(fit.degrees_of_freedom, 5);
  EXPECT_EQ(fit.effect, 0);
}

using Pools = std::vector<std::vector<std::size_t>>;

Pools pools(const ChiSquareFit& fit) {
  Pools all;
  for (const PooledCell& cell : fit.cells) all.push_back(cell.members);
  return all;
}

TEST(ChiSquareFit, SmallCellsAreGatheredInIndexOrderAndTheLastPoolIsFlushed) {
  CellCounts counts{{10, 10, 100, 10, 10, 10, 10}, {}};
  for (const double e : {12., 12., 88., 12., 12., 12., 12.}) counts.probability.push_back(e / 160);
  const ChiSquareFit fit = chi_square_fit(counts);
  EXPECT_EQ(pools(fit), (Pools{{0, 1}, {2}, {3, 4}, {5, 6}}));
  counts.observed.push_back(3);
  counts.probability.push_back(0.01);
  for (double& p : counts.probability) p /= 1.01;
  const ChiSquareFit more = chi_square_fit(counts);
  EXPECT_EQ(pools(more), (Pools{{0, 1}, {2}, {3, 4}, {5, 6, 7}}));
  EXPECT_EQ(more.degrees_of_freedom, 3);
}

// The lesser of the large cells, 45 expected, takes the small cell, as there is no other pool. Then
// 55 and 45 are observed where 50 and 50 are expected. X2 = 2 * 25 / 50 = 1, p = .31731051.
TEST(ChiSquareFit, ALoneRestJoinsTheLeastExpectedOfTheLargeCells) {
  const ChiSquareFit fit = chi_square_fit({{55, 40, 5}, {.5, .45, .05}});
  EXPECT_EQ(pools(fit), (Pools{{0}, {1, 2}}));
  EXPECT_NEAR(fit.test.statistic, 1, 1e-12);
  EXPECT_NEAR(std::exp(fit.test.log_p_upper), .31731051, 5e-9);
}

TEST(ChiSquareFit, PoolingDoesNotLookAtTheObservations) {
  const ChiSquareFit a = chi_square_fit({{1, 59, 20, 40}, {.1, .4, .1, .4}});
  const ChiSquareFit b = chi_square_fit({{59, 1, 40, 20}, {.1, .4, .1, .4}});
  EXPECT_EQ(pools(a), pools(b));
}

TEST(ChiSquareFit, AnImpossibleObservationRejectsAtOnce) {
  const CellCounts counts{{50, 49, 1}, {.5, .5, 0}};
  const ChiSquareFit strict = chi_square_fit(counts, {.probability_tolerance = 0});
  EXPECT_EQ(strict.impossible, 1U);
  EXPECT_EQ(strict.test.log_p_upper, std::numeric_limits<double>::lowest());
  const ChiSquareFit tolerant = chi_square_fit(counts, {.probability_tolerance = 1e-9});
  EXPECT_NEAR(std::exp(tolerant.test.log_p_upper), 2e-7, 1e-12);
}

// The law excludes one observation in a hundred, so w is at least (.01 - 1e-9) / sqrt(1e-9).
// Neither a small effect nor the absence of a large one can be shown.
TEST(ChiSquareFit, ImpossibleObservationsAreAnEffectThatNoAllowanceCovers) {
  const CellCounts counts{{4950, 4950, 100}, {.5, .5, 0}};
  const ChiSquareFit fit = chi_square_fit(counts, {.probability_tolerance = 1e-9});
  EXPECT_NEAR(fit.effect, .01 / std::sqrt(1e-9), 1);
  const TestResult small = chi_square_fit_effect(fit, .1);
  EXPECT_LT(small.log_p_upper, std::log(1e-9));
  EXPECT_NEAR(small.log_p_lower, 0, 1e-12);
  const Interval interval = chi_square_evidence(fit).interval(.98);
  EXPECT_GT(interval.low, 200);
  EXPECT_LT(interval.high, 500);
  const ChiSquareFit strict = chi_square_fit(counts, {.probability_tolerance = 0});
  EXPECT_EQ(strict.effect, std::numeric_limits<double>::infinity());
  EXPECT_EQ(chi_square_evidence(strict).interval(.98).high,
            std::numeric_limits<double>::infinity());
}

// Within the tolerance, quadrature may have missed them.
TEST(ChiSquareFit, AFewImpossibleObservationsAreTheTolerances) {
  const ChiSquareFit fit =
      chi_square_fit({{50000, 49999, 1}, {.5, .5, 0}}, {.probability_tolerance = 1e-5});
  EXPECT_LT(chi_square_fit_effect(fit, .1).log_p_lower, std::log(1e-3));
}

// Probabilities are off by as much as they say, up and down in turn, which makes w = .02. With this
// n X2 alone rejects every time. Neither the truth nor its near contrary may be rejected more often
// than .01. Of 400 samples 14 or more have a probability of 1e-4.
TEST(ChiSquareFit, ErrorsOfTheProbabilitiesAreAllowedForBothWays) {
  constexpr std::size_t cells = 64;
  constexpr double error = .02 / cells;
  constexpr std::uint64_t n = 1000000;
  std::vector<double> off(cells);
  for (std::size_t i = 0; i < cells; ++i) off[i] = 1.0 / cells + (i % 2 == 0 ? error : -error);
  const std::vector<double> truth(cells, 1.0 / cells);
  tests::Philox random(1254);
  int refuted = 0, excluded = 0, by_exact = 0;
  for (int run = 0; run < 400; ++run) {
    CellCounts counts{.observed = tests::multinomial(random, n, truth), .probability = off};
    by_exact += chi_square_fit(counts).test.log_p_upper < std::log(.01);
    counts.error.assign(cells, error);
    const ChiSquareFit fit = chi_square_fit(counts);
    EXPECT_NEAR(fit.error_effect, .02, 1e-4);
    refuted += fit.test.log_p_upper < std::log(.01);
    excluded += chi_square_fit_effect(fit, .0001).log_p_lower < std::log(.01);
  }
  EXPECT_EQ(by_exact, 400);
  EXPECT_LT(refuted, 14);
  EXPECT_LT(excluded, 14);
}

// Counts equal their expectations to the last one. Chance leaves more, even where w = 0.
TEST(ChiSquareFit, DataTooCloseToTheLawHaveNoIntervalRatherThanOneOfNoWidth) {
  const CellCounts even{.observed = std::vector<std::uint64_t>(100, 100),
                        .probability = std::vector<double>(100, .01)};
  const ChiSquareFit fit = chi_square_fit(even);
  const Interval interval = chi_square_evidence(fit).interval(.92);
  EXPECT_TRUE(std::isnan(interval.low) && std::isnan(interval.high)) << interval.high;
  // The test at an effect stands: a large one is excluded.
  EXPECT_LT(chi_square_fit_effect(fit, .1).log_p_lower, std::log(.01));
}

TEST(ChiSquareFit, TheEffectMovesTheNullAndTheIntervalInvertsIt) {
  const CellCounts counts{{700, 300, 500, 500}, {.25, .25, .25, .25}};
  const ChiSquareFit fit = chi_square_fit(counts);
  // X2 = 2 * 200^2 / 500 = 160
  EXPECT_NEAR(fit.test.statistic, 160, 1e-12);
  const double pairs = 700 * 699 + 300 * 299 + 2 * 500 * 499;
  EXPECT_NEAR(fit.effect, std::sqrt(pairs / (2000 * 1999 * .25) - 1), 1e-12);
  EXPECT_NEAR(chi_square_fit_effect(fit, 0).log_p_upper / fit.test.log_p_upper, 1, .01);
  const Interval interval = chi_square_evidence(fit).interval(.98);
  EXPECT_LT(interval.low, fit.effect);
  EXPECT_GT(interval.high, fit.effect);
  EXPECT_NEAR(chi_square_fit_effect(fit, interval.low).log_p_upper, std::log(.01), 1e-6);
  EXPECT_NEAR(chi_square_fit_effect(fit, interval.high).log_p_lower, std::log(.01), 1e-6);
  const ChiSquareFit small = chi_square_fit(golden(), {.minimum_expected = 5});
  EXPECT_EQ(chi_square_evidence(small).interval(.98).low, 0);
}

}  // namespace
}  // namespace assay::stats
