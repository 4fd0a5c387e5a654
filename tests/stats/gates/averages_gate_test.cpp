#include "stats/gates/averages_gate.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

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
