#include "stats/basics/moments.h"
#include "stats/cells/chi_square.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

/// Cells of equal probability, or one of `rare` among equal ones. The first or the rare one comes
/// `factor` times as often.
struct Tilted {
  std::vector<double> null, law;
};

Tilted tilted(std::size_t cells, double rare, double factor) {
  Tilted result{.null = std::vector<double>(cells, (1 - rare) / static_cast<double>(cells - 1)),
                .law = {}};
  result.null[0] = rare;
  const double left = (1 - factor * rare) / (1 - rare);
  for (const double p : result.null) result.law.push_back(p * left);
  result.law[0] = factor * rare;
  return result;
}

double effect_of(const Tilted& cells) {
  double sum = 0;
  for (std::size_t i = 0; i < cells.null.size(); ++i) {
    sum += std::pow(cells.law[i] - cells.null[i], 2) / cells.null[i];
  }
  return std::sqrt(sum);
}

std::vector<PooledCell> cells_of(const std::vector<std::uint64_t>& counts,
                                 const std::vector<double>& null, std::uint64_t n) {
  std::vector<PooledCell> cells;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    cells.push_back({counts[i], static_cast<double>(n) * null[i], {}});
  }
  return cells;
}

// U = sum of O (O-1) / p0 over n (n-1), less 1, by hand.
TEST(CellEffect, IsEstimatedFromPairsInOneCell) {
  const CellEffect effect(std::vector<PooledCell>{{6, 5, {}}, {3, 2.5, {}}, {1, 2.5, {}}}, 10);
  EXPECT_NEAR(effect.squared(), (6 * 5 / .5 + 3 * 2 / .25 + 0) / 90 - 1, 1e-12);
}

// Over 4000 samples the mean of U lies within five of its standard errors of w^2: 6e-7.
TEST(CellEffect, IsWithoutBias) {
  const Tilted cells = tilted(65, 2e-4, 5);
  Philox random(1252);
  Moments squared;
  for (int run = 0; run < 4000; ++run) {
    const auto counts = multinomial(random, 20000, cells.law);
    squared.add(CellEffect(cells_of(counts, cells.null, 20000), 20000).squared());
  }
  EXPECT_NEAR(squared.mean, std::pow(effect_of(cells), 2), 5 * squared.standard_error());
}

TEST(CellEffect, HasFallingAndRisingTails) {
  const Tilted cells = tilted(64, 1 / 64.0, 3);
  Philox random(1253);
  const CellEffect effect(cells_of(multinomial(random, 20000, cells.law), cells.null, 20000),
                          20000);
  LogTails before = effect.tails(0);
  for (double w = .01; w < 1; w += .01) {
    const LogTails tails = effect.tails(w);
    EXPECT_GE(tails.upper, before.upper) << w;
    EXPECT_LE(tails.lower, before.lower) << w;
    before = tails;
  }
}

// X2 spreads more than any noncentral chi-square where one cell carries the effect
// (measurements.md). Both directions are at most 1.5 times .01 and .001, plus 4.5 binomial standard
// errors for this sample. False alarms 1e-4 over the sixteen.
TEST(CellEffect, HoldsItsLevelWhereOneCellCarriesIt) {
  const struct {
    Tilted cells;
    std::uint64_t n;
  } cases[] = {{tilted(512, 1 / 512.0, 5), 100000},
               {tilted(64, 1 / 64.0, 3), 20000},
               {tilted(65, 2e-4, 50), 100000},
               {tilted(64, 1 / 64.0, 1e-9), 20000}};
  constexpr int runs = 4000;
  Philox random(1251);
  for (const auto& [cells, n] : cases) {
    const double effect = effect_of(cells);
    std::vector<TestResult> results;
    for (int run = 0; run < runs; ++run) {
      const auto fit = chi_square_fit({multinomial(random, n, cells.law), cells.null});
      results.push_back(chi_square_fit_effect(fit, effect));
    }
    for (const double level : {.01, .001}) {
      const double most = runs * 1.5 * level + 4.5 * std::sqrt(runs * 1.5 * level);
      for (const auto tail : {&TestResult::log_p_upper, &TestResult::log_p_lower}) {
        const auto rejected = [&](double log_p) { return log_p < std::log(level); };
        EXPECT_LT(std::ranges::count_if(results, rejected, tail), most) << effect;
      }
    }
  }
}

}  // namespace
}  // namespace assay::stats
