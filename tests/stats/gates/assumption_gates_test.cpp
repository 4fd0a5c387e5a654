#include "stats/gates/assumption_gates.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(AssumptionGates, ThePilotChoosesPrimariesForVariances) {
  // Exponential: excess kurtosis 6, so 30 primaries a secondary.
  EXPECT_EQ(primaries_for_variance(6), 30U);
  EXPECT_EQ(primaries_for_variance(-1), 1U);
}

TEST(AssumptionGates, SkewnessValueIsTheFactorOfTheFormula) {
  Moments x = draw_moments(400, [k = 0]() mutable { return std::exp(.01 * ++k); });
  const Gate gate = skewness_gate(x, 3);
  EXPECT_NEAR(gate.value, std::exp(x.skewness() * 27 / (3 * 20)), 1e-12);
  EXPECT_LE(gate.low, gate.value);
  EXPECT_EQ(gate.limit, 2);
  // Against itself the skewness of a difference cancels.
  EXPECT_NEAR(skewness_gate(x, x, 1, 3).value, 1, 1e-12);
  EXPECT_GT(skewness_gate(x, x, -1, 3).value, 1.05);
}

// Each observation's influence on a contrast's mean: (x - mean x) / n_x, or -scale (y - mean y) /
// n_y.
std::vector<double> influences(const std::vector<double>& values, double scale) {
  const double mean = moments_of(values).mean;
  std::vector<double> psi;
  for (const double value : values) {
    psi.push_back(scale * (value - mean) / static_cast<double>(values.size()));
  }
  return psi;
}

std::vector<double> skewed_values(std::size_t n, double rate) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    values[i] = std::exp(rate * static_cast<double>(i) / static_cast<double>(n));
  }
  return values;
}

// 2 |a| x^3 with a = sum psi^3 / (6 (sum psi^2)^1.5) over both samples' influences. The gate's
// variances divide by n - 1, which is half a per cent of the exponent at these sizes.
TEST(AssumptionGates, TheSkewnessOfAContrastIsThatOfItsInfluences) {
  const std::vector<double> x = skewed_values(400, 4);
  const std::vector<double> y = skewed_values(150, 5);
  for (const double scale : {.05, .3, -.3, 1.0, -2.0}) {
    double squares = 0, cubes = 0;
    for (const auto& psi : {influences(x, 1), influences(y, -scale)}) {
      for (const double each : psi) squares += each * each, cubes += each * each * each;
    }
    const double exponent = 2 * std::abs(cubes / (6 * std::pow(squares, 1.5))) * 27;
    const Gate gate = skewness_gate(moments_of(x), moments_of(y), scale, 3);
    EXPECT_NEAR(std::log(gate.value), exponent, .01 * exponent) << scale;
  }
}

// n observations of skewness g1 and kurtosis b2, mean 0 and m2 = n.
Moments shaped(double n, double g1, double b2) {
  Moments x;
  x.count = static_cast<std::uint64_t>(n);
  x.m2 = n;
  x.m3 = n * g1;
  x.m4 = n * b2;
  return x;
}

// tests/tables/gates.csv has the quantiles of g1 and b2 for normal data. The widening to a gamma
// law is from the influence of one observation, integrated over its density.
TEST(AssumptionGates, ConfidenceLimitsTakeOffTheWidenedNormalQuantile) {
  for (const tests::Row& row : tests::read_table("gates")) {
    const double cube = row["x"] * row["x"] * row["x"];
    const double allowance = row["skewness_quantile"] * row["skewness_widening"];
    const Gate skewness = skewness_gate(shaped(row["n"], allowance + 1, 10), row["x"]);
    ASSERT_LT(std::log(skewness.value), 700);
    EXPECT_NEAR(std::log(skewness.value / skewness.low) / cube * 3 * std::sqrt(row["n"]), allowance,
                1e-9 * allowance)
        << row.text("n");
    const double spread = row["kurtosis_quantile"] * row["kurtosis_widening"];
    const Gate kurtosis = kurtosis_gate(shaped(row["n"], 0, 3 + spread + 1));
    EXPECT_NEAR(kurtosis.value - kurtosis.low, spread, 1e-9 * spread) << row.text("n");
  }
}

// Both samples' allowances are added at right angles, each times its share of the variance to the
// power 1.5.
TEST(AssumptionGates, TheConfidenceLimitOfAContrastHasBothAllowances) {
  const auto rows = tests::read_table("gates");
  const tests::Row& of_x = rows.at(4);
  const tests::Row& of_y = rows.at(2);
  ASSERT_EQ(of_x["x"], of_y["x"]);
  const double n = of_x["n"];
  const double m = of_y["n"];
  const double vx = 1 / (n - 1);
  const double vy = .25 / (m - 1);
  const auto weight = [&](double v, double size) {
    return std::pow(v / (vx + vy), 1.5) / (3 * std::sqrt(size));
  };
  const double allowance =
      std::hypot(weight(vx, n) * of_x["skewness_quantile"] * of_x["skewness_widening"],
                 weight(vy, m) * of_y["skewness_quantile"] * of_y["skewness_widening"]);
  const Gate gate = skewness_gate(shaped(n, 5, 30), shaped(m, -5, 30), .5, of_x["x"]);
  const double cube = std::pow(of_x["x"], 3);
  EXPECT_NEAR(std::log(gate.value / gate.low) / cube, allowance, 1e-9 * allowance);
}

// A sample of n with s = 1 whose largest deviation is this.
Moments with_largest(double n, double deviation) {
  Moments x = shaped(n, 0, 3);
  x.m2 = n - 1;
  x.minimum = -.1;
  x.maximum = deviation;
  return x;
}

// The 5 % and 1e-4 critical values, from the Beta law of one residual. Grubbs (1969) prints 2.71
// for n = 20 at 2.5 % one-sided.
TEST(AssumptionGates, DominanceTurnsAtTheCriticalValuesOfGrubbs) {
  for (const tests::Row& row : tests::read_table("gates")) {
    const double n = row["n"];
    const auto share = [n](double deviation) { return deviation * deviation / (n - 1); };
    const double limit = std::max(.5, share(row["grubbs_0001"]));
    EXPECT_NEAR(dominance_gate(with_largest(n, 1)).limit, limit, 1e-9) << n;
    const double green = std::sqrt((n - 1) * std::max(.25, share(row["grubbs_05"])));
    EXPECT_EQ(dominance_gate(with_largest(n, green * (1 - 1e-6))).state, GateState::green) << n;
    EXPECT_NE(dominance_gate(with_largest(n, green * (1 + 1e-6))).state, GateState::green) << n;
    const double red = std::sqrt((n - 1) * limit);
    EXPECT_NE(dominance_gate(with_largest(n, red * (1 - 1e-6))).state, GateState::red) << n;
    EXPECT_EQ(dominance_gate(with_largest(n, red * (1 + 1e-6))).state, GateState::red) << n;
  }
}

struct Study {
  std::uint32_t test_case;
  std::size_t n;
  std::size_t runs;
};

int reds(const Study& study, const std::function<double(Philox&)>& draw,
         const std::function<Gate(const Moments&)>& gate) {
  Philox random(study.test_case);
  int red = 0;
  for (std::size_t i = 0; i < study.runs; ++i) {
    red += gate(draw_moments(study.n, [&] { return draw(random); })).state == GateState::red;
  }
  return red;
}

bool too_many_of(int reds, std::size_t runs, double rate) {
  const double n = static_cast<double>(runs);
  std::cout << "  red " << reds << " of " << runs << "\n";
  return tests::too_many(reds / n, rate, n);
}

Gate strict_skewness(const Moments& x) { return skewness_gate(x, 4.42); }
Gate dominance(const Moments& x) { return dominance_gate(x); }

// In 20000 repetitions at a rate of 1e-4, 2 reds are expected.
TEST(AssumptionGates, NormalDataAreRedLessThanOnceInTenThousand) {
  const auto normal = [](Philox& random) { return random.normal(); };
  Study study{.test_case = 301, .n = 0, .runs = tests::repetitions(20000)};
  for (const std::size_t n : {5UL, 10UL, 20UL, 50UL, 100UL, 400UL}) {
    study.n = n;
    for (const auto gate : {strict_skewness, dominance, kurtosis_gate}) {
      EXPECT_FALSE(too_many_of(reds(study, normal, gate), study.runs, 1e-4)) << n;
    }
    ++study.test_case;
  }
}

// At these gamma laws the value equals the limit. Reds must stay rare there too, 2e-3 at most.
TEST(AssumptionGates, LawsAtTheLimitAreSeldomRed) {
  const std::size_t runs = tests::repetitions(20000);
  // Sums of k exponentials have skewness 2 / sqrt(k) and excess kurtosis 6 / k: k = 30 has .2.
  const auto sum_of = [](int k) {
    return [k](Philox& random) {
      double product = 1;
      for (int i = 0; i < k; ++i) product *= random.uniform();
      return -std::log(product);
    };
  };
  EXPECT_FALSE(too_many_of(reds({310, 400, runs}, sum_of(30), kurtosis_gate), runs, 2e-3));
  // n = 100, x = 3: skewness limit 3 sqrt(100) ln 2 / 27 = .77, k = 6.7.
  const auto skewness = [](const Moments& x) { return skewness_gate(x, 3); };
  EXPECT_FALSE(too_many_of(reds({311, 100, runs}, sum_of(7), skewness), runs, 2e-3));
}

// Exact binomial: at a true rate of .99 fewer than 960 of 1000 have probability below 1e-13.
TEST(AssumptionGates, GrossViolationsAreRed) {
  const auto exponential = [](Philox& random) { return random.exponential(); };
  EXPECT_GE(reds({320, 1000, 1000}, exponential, kurtosis_gate), 960);
  const auto rare = [](Philox& random) { return random.uniform() < .01 ? 1.0 : 0.0; };
  EXPECT_GE(reds({321, 2000, 1000}, rare, strict_skewness), 960);
  Moments spike = draw_moments(1000, [k = 0]() mutable { return std::sin(++k); });
  spike.add(100);
  EXPECT_EQ(dominance_gate(spike).state, GateState::red);
}

// Squared deviations over n^2, summed as they stand.
TEST(AssumptionGates, EffectiveObservationsWeighSquaresByTheirShare) {
  double sum = 0, squares = 0;
  const auto take = [&](const std::vector<double>& values, const Moments& moments) {
    for (const double value : values) {
      const double weight =
          std::pow((value - moments.mean) / static_cast<double>(values.size()), 2);
      sum += weight;
      squares += weight * weight;
    }
    return sum * sum / squares;
  };
  const std::vector<double> others = tests::table_sample(4, 90);
  Moments x = moments_of(tests::table_sample(3, 200));
  const double one = take(tests::table_sample(3, 200), x);
  EXPECT_NEAR(effective_observations_gate({&x, 1}).value, one, 1e-9 * one);
  const double two = take(others, moments_of(others));
  EXPECT_NEAR(effective_observations_gate(std::vector{x, moments_of(others)}).value, two,
              1e-9 * two);
  x.m4 = 0;
  EXPECT_LT(effective_observations_gate({&x, 1}).value, one);
}

// The first k of n values are 1, the others 0. With p = k / n the number is
// n p (1 - p) / (1 - 3 p (1 - p)). That is nearly k.
TEST(AssumptionGates, RareValuesCountAsEffectiveObservations) {
  const auto state = [](int rare) {
    const Moments moments =
        draw_moments(20000, [k = 0, rare]() mutable { return k++ < rare ? 1 : 0; });
    return effective_observations_gate({&moments, 1}).state;
  };
  EXPECT_EQ(state(31), GateState::red);
  EXPECT_EQ(state(33), GateState::amber);
  EXPECT_EQ(state(65), GateState::green);
}

std::vector<double> rounded(double steps, std::size_t n, std::uint32_t stream) {
  Philox random(stream);
  return sorted(sample_of(n, [&] { return std::round(random.uniform() * steps) / steps; }));
}

// sum p^2 of 256 equal steps is 1 / 256; rejected at .01 is sqrt(ln(200) / (2 n)).
TEST(QuantisationGate, ValueIsHalfAStepOverTheRejectedDistance) {
  const std::size_t n = 20000;
  const Gate gate = quantisation_gate(rounded(256, n, 1), 0.01);
  const double rejected = std::sqrt(std::log(200) / (2 * static_cast<double>(n)));
  EXPECT_NEAR(gate.value, 1 / 256.0 / (2 * rejected), 0.02 * gate.value);
  EXPECT_EQ(gate.state, GateState::red);
}

TEST(QuantisationGate, LetsFineStepsAndAtomsPass) {
  EXPECT_EQ(quantisation_gate(rounded(1e6, 20000, 2), 0.01).state, GateState::green);
  // An atom among continuous values is a matter of the law, not of rounding.
  Philox random(3);
  const auto atoms = sample_of(2000, [&] { return std::max(0.3, random.uniform()); });
  EXPECT_EQ(quantisation_gate(sorted(atoms), 0.01).value, 0);
}

using Draw = std::function<double(Philox&)>;

const std::vector<std::pair<const char*, Draw>> drawn_laws{
    {"normal", [](Philox& random) { return random.normal(); }},
    {"lognormal(0, 2)", [](Philox& random) { return std::exp(2 * random.normal()); }},
    {"Pareto 2.1", [](Philox& random) { return std::pow(1 - random.uniform(), -1 / 2.1); }},
    {"spike of 1e-3", [](Philox& random) { return random.uniform() < 1e-3 ? 1000.0 : 1.0; }}};

std::vector<double> means_of(const Draw& draw, std::size_t count, std::size_t each,
                             Philox& random) {
  std::vector<double> means;
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < each; ++k) sum += draw(random);
    means.push_back(sum / static_cast<double>(each));
  }
  return means;
}

constexpr std::size_t each = 32;
constexpr std::size_t averages = 64;

double log_p(const Draw& draw, Philox& random, std::size_t taken) {
  const std::vector<double> values = means_of(draw, each * averages, 1, random);
  const double z = averages_gate(values, means_of(draw, averages, taken, random), each).value;
  // Two statistics, each on both sides.
  return std::min(0.0, normal_tails(z).upper + std::log(4.0));
}

TEST(AveragesGate, IsCalibratedAtAnyLaw) {
  std::uint32_t number = 0;
  for (const auto& [name, draw] : drawn_laws) {
    SCOPED_TRACE(name);
    expect_calibrated({7100 + number++, tests::repetitions(4000), Shape::at_most_uniform},
                      [&](Philox& random) { return log_p(draw, random, each); });
  }
}

// Observations of 24 primaries that are said to be of 32.
CAUGHT(AveragesGate, OfFewerPrimariesIsCaught, 7110, 4000, Shape::at_most_uniform) {
  return log_p(drawn_laws[0].second, random, 24);
}

// One of 1000 seeds is accused with probability 1e-4.
TEST(AveragesGate, AccusesNoMeans) {
  Philox random(7111);
  for (const auto& [name, draw] : drawn_laws) {
    for (int run = 0; run < 250; ++run) {
      const std::vector<double> values = means_of(draw, 8192, 1, random);
      const Gate gate = averages_gate(values, means_of(draw, 256, each, random), each);
      EXPECT_NE(gate.state, GateState::red) << name << " " << gate.value;
    }
  }
}

// Most means are 10.149248115565992. Sums in single precision and of quotients round it otherwise.
TEST(AveragesGate, OfFrequentValuesHearsNoRounding) {
  Philox random(7113);
  const auto draw = [&] { return 10.149248115565992 + (random.uniform() < .001 ? 500 : 0); };
  for (int run = 0; run < 20; ++run) {
    std::vector<double> values(8192);
    for (double& value : values) value = draw();
    std::vector<double> in_single, times;
    for (int i = 0; i < 256; ++i) {
      float sum = 0;
      double other = 0;
      for (std::size_t k = 0; k < each; ++k) {
        const double value = draw();
        sum += static_cast<float>(value);
        other += value / static_cast<double>(each);
      }
      in_single.push_back(static_cast<double>(sum / static_cast<float>(each)));
      times.push_back(other);
    }
    for (const auto& means : {in_single, times}) {
      EXPECT_NE(averages_gate(values, means, each).state, GateState::red) << run;
    }
  }
}

TEST(AveragesGate, SeesWhatIsNoMean) {
  Philox random(7112);
  for (int run = 0; run < 50; ++run) {
    for (const auto& [name, draw] : {drawn_laws[0], drawn_laws[1], drawn_laws[2]}) {
      const std::vector<double> values = means_of(draw, 8192, 1, random);
      const Gate of_one_primary = averages_gate(values, means_of(draw, 256, 1, random), each);
      EXPECT_EQ(of_one_primary.state, GateState::red) << name;
    }
    const Draw& normal = drawn_laws[0].second;
    const std::vector<double> values = means_of(normal, 8192, 1, random);
    const auto state_of = [&](const std::function<double(double)>& changed) {
      std::vector<double> means = means_of(normal, 256, each, random);
      for (double& mean : means) mean = changed(mean);
      return averages_gate(values, means, each).state;
    };
    const auto sharing = [&](double mean) { return mean + .4 * random.normal(); };
    EXPECT_EQ(state_of(sharing), GateState::red) << "an offset that all primaries share";
    EXPECT_EQ(state_of([](double mean) { return mean / 2; }), GateState::red) << "stratified";
    EXPECT_EQ(state_of([](double mean) { return mean + .2; }), GateState::red);
  }
}

// The larger of two z, from scores and their permutation moments in R:
//   x <- c(1:16, 3.01 * (1:16)); a <- qnorm((rank(x) - .5) / 32); k <- 16
//   s <- function(a) sqrt(k * k / (32 * 31) * sum((a - mean(a))^2))
//   z <- function(a) abs(sum(a[1:k]) - k * mean(a)) / s(a); c(z(a), z(a^2))
TEST(AveragesGate, AgreesWithR) {
  std::vector<double> values(16);
  std::iota(values.begin(), values.end(), 1.0);
  std::vector<double> means;
  for (const double value : values) means.push_back(3.01 * value);
  EXPECT_NEAR(averages_gate(values, means, 1).value, 3.402320526064484, 1e-9);
}

TEST(AveragesGate, OfTooFewMeansSaysNothing) {
  const std::vector<double> values(600, 1.0);
  EXPECT_EQ(averages_gate(values, std::vector<double>(15, 2.0), 32).state, GateState::green);
  EXPECT_EQ(averages_gate(values, std::vector<double>(256, 2.0), 64).value, 0);
}

}  // namespace
}  // namespace assay::stats
