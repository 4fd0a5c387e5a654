#include "stats/means/betting_mean.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

constexpr Range unit{0, 1};
constexpr double lowest = std::numeric_limits<double>::lowest();

// make_means.py, fractions.
std::vector<double> fractions(int k, int n) {
  std::vector<double> values;
  for (int i = 1; i <= n; ++i) {
    const double u = i * ((std::sqrt(5.0) - 1) / 2);
    values.push_back(std::pow(u - std::floor(u), k));
  }
  return values;
}

TestResult betting(const std::vector<double>& values, Range range, double null) {
  return betting_mean(ValueCells(values), range, null);
}

// The bets that the header names.
double bet(std::size_t index) {
  const std::array<double, 3> large{1 - 1 / 1024.0, 0.875, 0.6875};
  return index < large.size() ? large[index] : std::pow(2.0, 2 - static_cast<double>(index));
}

// The products of the definition, value by value.
double log_p_upper_one_by_one(const std::vector<double>& values, Range range, double null) {
  std::vector<double> logs(bet_count, 0);
  for (std::size_t k = 0; k < bet_count; ++k) {
    for (const double x : values) logs[k] += std::log1p(bet(k) * (x - null) / (null - range.low));
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double each : logs) sum += std::exp(each - most);
  return std::min(0.0, -(most + std::log(sum / static_cast<double>(bet_count))));
}

TEST(BettingMean, AgreesWithTheProductsMultipliedOut) {
  for (const Row& row : tests::read_table("betting_mean")) {
    std::vector<double> values = fractions(static_cast<int>(row["k"]), static_cast<int>(row["n"]));
    for (double& value : values) value = -2 + 5 * row["part"] * value;
    const TestResult result = betting(values, {-2, 3}, row["null"]);
    EXPECT_NEAR(result.log_p_lower, row["log_lower"], 1e-12 * (1 - row["log_lower"]));
    EXPECT_NEAR(result.log_p_upper, row["log_upper"], 1e-12 * (1 - row["log_upper"]));
    EXPECT_EQ(result.distribution.family, "bound");
  }
}

// The merged cells never claim more wealth than the values have, and lose a hundredth of it at
// most.
TEST(BettingMean, MergedCellsLoseLittleAndGainNothing) {
  Philox random(1);
  const Law rare{"rare", 1.05, [](Philox& r) {
                   const double u = r.uniform();
                   return u < 1e-3 ? 1000 * u / 1e-3 * .1 : r.exponential();
                 }};
  for (const Law& law : {laws::uniform, laws::exponential, laws::lognormal_one, laws::bernoulli,
                         laws::zero_inflated, rare}) {
    for (const std::size_t n : {1000UL, 30000UL, 300000UL}) {
      const std::vector<double> values = draw_values(law, n, random);
      const ValueCells cells(values);
      EXPECT_LE(static_cast<double>(cells.cells().size()),
                64 * std::log(static_cast<double>(n) / 64) + 128);
      for (const double errors : {4.0, 7.0, 20.0}) {
        const double null = cells.mean() / (1 + errors / std::sqrt(static_cast<double>(n)));
        const double whole = log_p_upper_one_by_one(values, {0, infinity}, null);
        const double merged = betting_mean(cells, {0, infinity}, null).log_p_upper;
        EXPECT_GE(merged, whole * (1 + 1e-9)) << law.name;
        EXPECT_LE(merged, whole * .99) << law.name << n << " " << errors;
      }
    }
  }
}

TEST(BettingMean, PFallsAsTheNullMovesAway) {
  const ValueCells x(fractions(3, 5000));
  double above = 0, below = 0;
  for (int step = 1; step < 200; ++step) {
    const double reach = step / 200.0;
    const double higher = betting_mean(x, unit, x.mean() + (1 - x.mean()) * reach).log_p_lower;
    const double lower = betting_mean(x, unit, x.mean() * (1 - reach)).log_p_upper;
    EXPECT_LE(higher, above) << reach;
    EXPECT_LE(lower, below) << reach;
    above = higher;
    below = lower;
  }
}

// A mean of 1e-12 of the range keeps its digits on both sides.
TEST(BettingMean, OfATinyPartOfTheRangeKeepsItsDigits) {
  const ValueCells x(fractions(1, 4000));
  const Range wide{0, 1e12};
  const double at = betting_mean(x, wide, .8 * x.mean()).log_p_upper;
  EXPECT_NEAR(at, betting_mean(x, {0, infinity}, .8 * x.mean()).log_p_upper, 0);
  const double next = betting_mean(x, wide, .8 * x.mean() * (1 + 1e-9)).log_p_upper;
  EXPECT_LT(std::abs(next - at), 1e-5);
  EXPECT_GT(next, at);
}

// (1 - m)^n is the probability of n zeros. The first bet stakes nearly all, and is one of 23.
TEST(BettingMean, AConstantSampleIsAnExactPowerLessTheMixture) {
  const ValueCells zeros(std::vector<double>(1000, 0.0));
  EXPECT_EQ(zeros.cells().size(), 1U);
  EXPECT_EQ(betting_mean(zeros, unit, .02).log_p_upper, 0);
  const double exact = 1000 * std::log1p(-.02);
  const double log_p = betting_mean(zeros, unit, .02).log_p_lower;
  EXPECT_GT(log_p, exact);
  EXPECT_LT(log_p, exact + std::log(23.0) + .05);
}

TEST(BettingMean, AnImpossibleMeanIsRejectedOutright) {
  const std::vector<double> x = fractions(1, 20);
  EXPECT_EQ(betting(x, unit, 1.1).log_p_lower, lowest);
  EXPECT_EQ(betting(x, unit, 1.1).log_p_upper, 0);
  EXPECT_EQ(betting(x, unit, -.1).log_p_upper, lowest);
  EXPECT_EQ(betting(x, unit, -.1).log_p_lower, 0);
  EXPECT_EQ(betting(x, unit, 0).log_p_upper, lowest);
  EXPECT_EQ(betting({0, 0}, unit, 0).log_p_upper, 0);
}

TEST(BettingMean, ATailWithoutAnEndIsNeverRejected) {
  const std::vector<double> x = fractions(1, 200);
  EXPECT_EQ(betting(x, {0, infinity}, 5).log_p_lower, 0);
  EXPECT_EQ(betting(x, {-infinity, 1}, -5).log_p_upper, 0);
  EXPECT_LT(betting(x, {-infinity, 1}, .9).log_p_lower, std::log(1e-6));
}

TEST(BettingMean, AnImaginedValueWeighsAsManyAsItSays) {
  std::vector<double> values = fractions(1, 40);
  ValueCells imagined(values);
  imagined.add(.7, 3);
  values.insert(values.end(), 3, .7);
  EXPECT_NEAR(betting_mean(imagined, unit, .4).log_p_upper, betting(values, unit, .4).log_p_upper,
              1e-12);
  EXPECT_NEAR(imagined.mean(), ValueCells(values).mean(), 1e-14);
}

// ---- Two means

// The least of all splits on a fine grid.
TEST(BettingContrast, FindsTheNumberBetweenTheMeans) {
  const ValueCells x(fractions(1, 100));
  std::vector<double> halves = fractions(2, 120);
  for (double& value : halves) value /= 2;
  const ValueCells y(halves);
  for (const double scale : {1.0, -.5, 2.0}) {
    const double low = scale * y.mean() + .02;
    const double high = x.mean();
    double least = 0;
    for (int i = 1; i < 4000; ++i) {
      const double s = low + (high - low) * i / 4000;
      const TestResult of_y = betting_mean(y, {0, .5}, (s - .02) / scale);
      least = std::min(least, std::max(betting_mean(x, unit, s).log_p_upper,
                                       scale > 0 ? of_y.log_p_lower : of_y.log_p_upper));
    }
    const TestResult result = betting_contrast(x, unit, y, {0, .5}, {scale, .02});
    EXPECT_NEAR(result.log_p_upper, std::min(0.0, std::log(2.0) + least), 2e-2 * (1 - least));
    EXPECT_EQ(result.log_p_lower, 0);
    EXPECT_NEAR(result.statistic, high - low, 1e-14);
  }
}

TEST(BettingContrast, TheOtherWayRoundIsTheOtherTail) {
  const ValueCells x(fractions(1, 100));
  const ValueCells y(fractions(3, 90));
  const TestResult one = betting_contrast(x, unit, y, unit, {});
  const TestResult other = betting_contrast(y, unit, x, unit, {});
  EXPECT_LT(one.log_p_upper, std::log(.01));
  EXPECT_NEAR(one.log_p_upper, other.log_p_lower, 1e-3);
}

TEST(BettingContrast, OfAScaleOfZeroIsOneMean) {
  const ValueCells x(fractions(1, 100));
  const ValueCells y(fractions(3, 90));
  EXPECT_EQ(betting_contrast(x, unit, y, unit, {0, .3}).log_p_upper,
            betting_mean(x, unit, .3).log_p_upper);
}

CALIBRATED(BettingContrast, KeepsItsLevel, 331, tests::repetitions(2000), Shape::at_most_uniform) {
  const ValueCells x(draw_values(laws::uniform, 60, random));
  const ValueCells y(draw_values(laws::zero_inflated_uniform, 60, random));
  return log_p_two_sided(betting_contrast(x, unit, y, unit, {5, 0}));
}

// Without a number between them: each sample against the other's mean.
CAUGHT(BettingContrast, AnEstimateTakenForExactIsNoticed, 332, 4000, Shape::at_most_uniform) {
  const ValueCells x(draw_values(laws::uniform, 3000, random));
  const ValueCells y(draw_values(laws::uniform, 20, random));
  return log_p_two_sided(betting_mean(x, unit, y.mean()));
}

// ---- Under the null, P(p <= a) <= a at the smallest p of ten looks. False alarms 1e-5 each.

double best_of_looks(const Law& law, Range range, bool upper, Philox& random) {
  std::vector<double> values;
  double best = 0;
  for (std::size_t look = 0; look < 10; ++look) {
    const auto more = draw_values(law, 10 + 10 * look, random);
    values.insert(values.end(), more.begin(), more.end());
    const TestResult result = betting(values, range, law.mean);
    best = std::min(best, upper ? result.log_p_upper : result.log_p_lower);
  }
  return best;
}

TEST(BettingMean, KeepsItsLevelUnderOptionalStoppingOnEveryLaw) {
  std::uint32_t test_case = 301;
  const auto keeps = [&](const Law& law, Range range, bool upper) {
    SCOPED_TRACE(law.name);
    expect_calibrated({test_case++, tests::repetitions(2000), Shape::at_most_uniform},
                      [&](Philox& random) { return best_of_looks(law, range, upper, random); });
  };
  for (const Law& law : {laws::exponential, laws::lognormal_half, laws::lognormal_one,
                         laws::bernoulli, laws::uniform, laws::zero_inflated}) {
    keeps(law, {0, infinity}, true);
  }
  for (const Law& law : {laws::bernoulli, laws::uniform, laws::zero_inflated_uniform}) {
    keeps(law, unit, false);
  }
}

// ---- Mutants

// Values below the declared end count as the end: half of the room below the mean is missing.
CAUGHT(BettingMean, ARangeOfHalfTheTrueOneIsNoticed, 321, 1000, Shape::at_most_uniform) {
  std::vector<double> values = draw_values(laws::uniform, 1000, random);
  for (double& value : values) value = std::max(value, .25);
  return betting(values, {.25, 1}, laws::uniform.mean).log_p_upper;
}

// Each bet is the best of the values so far, with the one that it is placed on.
CAUGHT(BettingMean, ABetThatKnowsTheMeanOfTheDataIsNoticed, 322, 4000, Shape::at_most_uniform) {
  double excess = 0, squares = 0, log_wealth = 0;
  for (int i = 0; i < 100; ++i) {
    const double gain = random.uniform() / laws::uniform.mean - 1;
    excess += gain;
    squares += gain * gain;
    log_wealth += std::log1p(std::clamp(excess / squares, 0.0, .9) * gain);
  }
  return std::min(0.0, -log_wealth);
}

// ---- Power

// A range far beyond the values costs the tail at its near end nothing.
TEST(BettingMean, FindsValuesTooLargeWhateverTheRangeBeyondThem) {
  for (const double high : {1.0, 1e3, 1e9}) {
    Philox random(284);
    int found = 0;
    for (int run = 0; run < 200; ++run) {
      found += betting(draw_values(laws::uniform, 1600, random), {0, high}, .45).log_p_upper <=
                       std::log(1e-3)
                   ? 1
                   : 0;
    }
    EXPECT_GE(found, 190) << high;
  }
}

}  // namespace
}  // namespace assay::stats
