#include "stats/gates/dependence.h"
#include "stats/means/student_t.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

bool is_red(const Gate& gate) { return gate.state == GateState::red; }

// Each is red with probability 5e-5 on independent normal values. Of 20000 more than 8 have
// probability 1.2e-6 (Poisson, mean 1).
TEST(IndependenceGates, AreSilentOnIndependentValues) {
  Philox random(1);
  int lag = 0, batch = 0, lagged = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto x = sample_of(100, [&] { return random.normal(); });
    lagged += is_red(lagged_gate(x));
    lag += is_red(lag_one_gate(x));
    batch += is_red(batch_gate(x));
  }
  EXPECT_LE(std::max({lag, batch, lagged}), 8);
}

// Rare values that happen to be neighbours, or in one batch, are no dependence. With a normal law
// of the correlation .009 are red.
TEST(IndependenceGates, AreSeldomRedOnRareValues) {
  Philox random(4);
  int lag = 0, batch = 0;
  for (int k = 0; k < 4000; ++k) {
    const auto x = sample_of(300, [&] { return random.uniform() < .02 ? 1.0 : 0.0; });
    if (std::ranges::count(x, 1.0) == 0) continue;
    lag += is_red(lag_one_gate(x));
    batch += is_red(batch_gate(x));
  }
  EXPECT_LE(lag, 2);
  EXPECT_LE(batch, 8) << "of 4000; 2 are expected";
}

// Any law will do: in ranks two values far out are no correlation.
TEST(IndependenceGates, OfLagsAreSilentOnHeavyTailsAndTies) {
  Philox random(5);
  int red = 0;
  for (int k = 0; k < 2000; ++k) {
    red += is_red(lagged_gate(sample_of(400, [&] { return std::exp(3 * random.normal()); })));
    red += is_red(lagged_gate(sample_of(400, [&] { return random.uniform() < .05 ? 1.0 : 0.0; })));
  }
  EXPECT_LE(red, 4) << "of 4000; .2 are expected";
}

// Chains written step by step, one value of each in turn.
std::vector<double> taking_turns(std::size_t chains, std::size_t steps, double phi,
                                 Philox& random) {
  std::vector<std::vector<double>> all;
  for (std::size_t c = 0; c < chains; ++c) all.push_back(autoregressive(phi, steps, random));
  std::vector<double> rows;
  for (std::size_t step = 0; step < steps; ++step) {
    for (const std::vector<double>& chain : all) rows.push_back(chain[step]);
  }
  return rows;
}

TEST(IndependenceGates, SeeChainsThatTakeTurns) {
  Philox random(6);
  for (const std::size_t chains : {2U, 10U, 50U, 300U}) {
    const auto rows = taking_turns(chains, 6000 / chains, .8, random);
    EXPECT_TRUE(is_red(lagged_gate(rows))) << chains;
    EXPECT_GT(lagged_gate(rows).value, lagged_gate(rows).limit) << chains;
    EXPECT_GE(sufficient_batch(rows), 5 * chains) << chains;
  }
}

// A single chain needs no longer batches for it: ten of its times, 190.
TEST(IndependenceGates, OfLagsLeaveTheBatchesOfOneChain) {
  Philox random(7);
  const auto x = autoregressive(.9, 20000, random);
  EXPECT_LT(static_cast<double>(sufficient_batch(x)), 12 * autocorrelation_time(x));
}

TEST(IndependenceGates, SeeAChainAndItsAlternation) {
  Philox random(2);
  for (const double phi : {.5, -.5}) {
    const Gate gate = lag_one_gate(autoregressive(phi, 500, random));
    EXPECT_TRUE(is_red(gate));
    EXPECT_EQ(gate.value > gate.limit, phi > 0);
  }
}

GateState worst_of_draws(std::span<const double> values) {
  GateState worst = GateState::green;
  for (const Gate& gate : drawn_order_gates(values)) worst = std::max(worst, gate.state);
  return worst;
}

// Each of the two is amber with probability .01 at most. Of 4000 runs more than 128 have
// probability 1e-6, and fewer than 16 have 1e-9. Equal values are ranked alike in every run, so
// that runs of rare hits are no independent ones.
TEST(IndependenceGates, OfDrawsKeepTheirLevelAtAnyLaw) {
  Philox random(8);
  int amber = 0;
  for (int k = 0; k < 2000; ++k) {
    const auto worst = [&](auto draw) { return worst_of_draws(sample_of(200, draw)); };
    const auto normal = worst([&] { return random.normal(); });
    const auto heavy = worst([&] { return std::exp(2 * random.normal()); });
    const auto rare = worst([&] { return random.uniform() < .01 ? 1.0 : 0.0; });
    for (const GateState state : {normal, heavy, rare}) EXPECT_NE(state, GateState::red);
    amber += (normal == GateState::amber) + (heavy == GateState::amber);
  }
  EXPECT_GE(amber, 16);
  EXPECT_LE(amber, 128);
}

// The tail that decides: P(H / B > its limit) by a random order, which chi-square bounds. .01 of
// 20,000 is 200; more than 270 have probability 1e-6.
TEST(IndependenceGates, BatchRanksKeepTheLevelOfChiSquare) {
  Philox random(18);
  int red = 0;
  for (int k = 0; k < 20000; ++k) {
    const std::vector<double> values = sample_of(128, [&] { return random.uniform(); });
    red += drawn_order_gates(values)[1].state == GateState::amber;
  }
  EXPECT_LE(red, 270);
  EXPECT_GE(red, 40);
}

TEST(IndependenceGates, OfDrawsSeeMovingAveragesChainsAndSharedOffsets) {
  Philox random(9);
  for (int k = 0; k < 100; ++k) {
    std::vector<double> noise = sample_of(1004, [&] { return random.normal(); });
    std::vector<double> moving;
    for (std::size_t i = 0; i < 1000; ++i) {
      moving.push_back(std::accumulate(noise.begin() + static_cast<std::ptrdiff_t>(i),
                                       noise.begin() + static_cast<std::ptrdiff_t>(i + 5), 0.0));
    }
    EXPECT_EQ(worst_of_draws(moving), GateState::red);
    noise.insert(noise.end(), noise.begin(), noise.end());
    EXPECT_EQ(worst_of_draws(noise), GateState::red) << "seeds that come again";
    EXPECT_EQ(worst_of_draws(autoregressive(.5, 1000, random)), GateState::red);
    EXPECT_EQ(worst_of_draws(autoregressive(-.5, 1000, random)), GateState::red);
    const auto sharing = [&](std::size_t size, std::size_t length, double share) {
      double offset = 0;
      std::size_t at = 0;
      return sample_of(size, [&] {
        if (at++ % length == 0) offset = share * random.normal();
        return offset + random.normal();
      });
    };
    EXPECT_EQ(worst_of_draws(sharing(1000, 8, 1)), GateState::red);
    // The lags of neighbours have a correlation of .06 here. Batches of 256 vary 17 times too much.
    EXPECT_TRUE(is_red(drawn_order_gates(sharing(16384, 256, .25))[1]));
    EXPECT_TRUE(is_red(drawn_order_gates(autoregressive(.1, 16384, random))[0]));
  }
}

// A drift of one and a half deviations from end to end: neighbours hardly notice, batches do.
TEST(IndependenceGates, SeeADriftThatNeighboursDoNot) {
  Philox random(3);
  int neighbours = 0, batches = 0;
  for (int k = 0; k < 20; ++k) {
    double t = 0;
    const auto x = sample_of(400, [&] { return random.normal() + 1.5 * (t += 1. / 400); });
    neighbours += is_red(lag_one_gate(x));
    batches += is_red(batch_gate(x));
  }
  EXPECT_EQ(batches, 20);
  EXPECT_LT(neighbours, 15);
}

TEST(IndependenceGates, OfBatchesSeeThatValuesWithinEachAreEqual) {
  std::vector<double> blocks;
  for (int i = 0; i < 25; ++i) blocks.push_back(i / 5);
  EXPECT_TRUE(is_red(batch_gate(blocks)));
}

// (1 + .9) / (1 - .9) = 19; deviation of the estimate about 1.5 of 20000 values.
TEST(IndependenceGates, AutocorrelationTimeOfLongAndShortSequencesAgrees) {
  Philox random(4);
  const auto x = autoregressive(0.9, 30000, random);
  EXPECT_NEAR(autocorrelation_time(x), 19, 8);
  EXPECT_NEAR(autocorrelation_time(std::span(x).first(8000)), 19, 15);
  const std::size_t length = sufficient_batch(x);
  EXPECT_GE(length, default_batch(x.size()));
  EXPECT_GE(static_cast<double>(length), 10 * autocorrelation_time(x));
  EXPECT_GE(x.size() / length, 20U);
}

bool any_red(std::span<const double> x) {
  return is_red(lag_one_gate(x)) || is_red(lagged_gate(x)) || is_red(batch_gate(x));
}

/// `x` with the variance of its mean allowed for.
Moments allowed(std::span<const double> x) {
  Moments moments = tests::moments_of(x);
  moments.m2 *= allowance_for_dependence(x);
  return moments;
}

/// Number of pairs of samples of 100 that no gate turns away and that Welch's test finds to differ
/// at .01.
struct Differing {
  int allowing = 0, plainly = 0;
};

Differing differing(int pairs, const std::function<std::vector<double>()>& draw) {
  Differing count;
  for (int k = 0; k < pairs; ++k) {
    const std::vector<double> x = draw();
    const std::vector<double> y = draw();
    if (any_red(x) || any_red(y)) continue;
    const auto differ = [](const Moments& a, const Moments& b) {
      return log_p_two_sided(welch_t(a, b, {})) < std::log(.01);
    };
    count.allowing += differ(allowed(x), allowed(y));
    count.plainly += differ(tests::moments_of(x), tests::moments_of(y));
  }
  return count;
}

// The gates see dependence in one pair of four. Without the allowance true equalities of the others
// fail in 170 of 4000. With it 60 are expected (.015), and more than 80 have probability .006.
// Independent values give 40 (.01): more than 80 have 1e-8, fewer than 15 have 1e-4.
TEST(IndependenceGates, WhatTheyDoNotSeeIsAllowedFor) {
  Philox random(11);
  const Differing chains = differing(4000, [&] { return autoregressive(.3, 100, random); });
  EXPECT_LE(chains.allowing, 80);
  EXPECT_GE(chains.plainly, 120);
  const Differing independent =
      differing(4000, [&] { return sample_of(100, [&] { return random.normal(); }); });
  EXPECT_GE(independent.allowing, 15);
  EXPECT_LE(independent.plainly, 80);
}

// The factor exceeds 1 beyond 5 % in neighbours or in batches of two lengths. Of 2000 independent
// samples some 260 are expected, and more than 330 have probability 1e-5.
TEST(IndependenceGates, LittleIsAllowedForInIndependentValues) {
  Philox random(12);
  int more = 0;
  for (int k = 0; k < 2000; ++k) {
    const double factor = allowance_for_dependence(sample_of(400, [&] { return random.normal(); }));
    EXPECT_GE(factor, 1);
    EXPECT_LT(factor, 5);
    more += factor > 1;
  }
  EXPECT_LE(more, 330);
  EXPECT_GE(more, 60);
}

}  // namespace
}  // namespace assay::stats
