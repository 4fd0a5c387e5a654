#include "metropolis/chain.h"
#include "metropolis/coordinates.h"
#include "tests/estimators/prelude.h"

namespace assay {
namespace {

using namespace assay::metropolis;

std::shared_ptr<const SmallStep> step(Boundary boundary) {
  return std::make_shared<SmallStep>(boundary);
}

Stream stream(std::uint64_t observation) {
  return Stream(stream_key(1, "lazy_coordinates_test", "", 0), observation);
}

TEST(SmallStep, IsBetweenItsSmallestAndItsLargest) {
  Stream random = stream(0);
  const SmallStep small(Boundary::wrap);
  for (int i = 0; i < 10000; ++i) {
    const double length = std::abs(small.step(random));
    EXPECT_GE(length, SmallStep::smallest * (1 - 1e-15));
    EXPECT_LE(length, SmallStep::largest * (1 + 1e-15));
  }
}

TEST(SmallStep, SettlesBeyondTheEndsAsItsBoundarySays) {
  const SmallStep wrap(Boundary::wrap);
  EXPECT_DOUBLE_EQ(*wrap.settled(-.01), .99);
  EXPECT_NEAR(*wrap.settled(1.01), .01, 1e-15);
  EXPECT_EQ(*wrap.settled(-1e-300), 0);
  EXPECT_EQ(*wrap.settled(1), 0);
  const SmallStep reflect(Boundary::reflect);
  EXPECT_DOUBLE_EQ(*reflect.settled(-.01), .01);
  EXPECT_NEAR(*reflect.settled(1.01), .99, 1e-15);
  EXPECT_LT(*reflect.settled(1), 1);
  const SmallStep reject(Boundary::reject);
  EXPECT_FALSE(reject.settled(-1e-300));
  EXPECT_FALSE(reject.settled(1));
  for (const double u : {0.0, .5, std::nextafter(1.0, 0.0)}) {
    EXPECT_EQ(*wrap.settled(u), u);
    EXPECT_EQ(*reflect.settled(u), u);
    EXPECT_EQ(*reject.settled(u), u);
  }
}

TEST(LazyCoordinates, ComeBackAfterARejection) {
  LazyCoordinates state(step(Boundary::wrap));
  Stream random = stream(1);
  state.restart();
  state.propose(true, random);
  const std::array<double, 3> first = {state.uniform(), state.uniform(), state.uniform()};
  state.accept();
  for (const bool large : {true, false, true, true, false, false}) {
    state.propose(large, random);
    for (int i = 0; i < 3; ++i) state.uniform();
    state.reject();
  }
  // All are a small step from where they were.
  state.propose(false, random);
  for (const double x : first) {
    const double away = std::abs(state.uniform() - x);
    EXPECT_LE(std::min(away, 1 - away), SmallStep::largest * (1 + 1e-12));
  }
}

TEST(LazyCoordinates, ALargeStepForgetsThoseThatNobodyLookedAt) {
  int near = 0;
  for (int i = 0; i < 1000; ++i) {
    LazyCoordinates state(step(Boundary::wrap));
    Stream random = stream(static_cast<std::uint64_t>(i));
    state.restart();
    state.propose(true, random);
    state.uniform();
    const double second = state.uniform();
    state.accept();
    state.propose(true, random);
    state.uniform();  // of one coordinate
    state.accept();
    state.propose(false, random);
    state.uniform();
    const double away = std::abs(state.uniform() - second);
    near += std::min(away, 1 - away) <= SmallStep::largest;
  }
  // 1 / 32 of uniform ones: 31 of 1000; the binomial exceeds 65 with probability 1e-8.
  EXPECT_LT(near, 66);
  EXPECT_GT(near, 5);
}

// Missed steps have the law of as many steps one by one. The variance of k + 1 steps is (k + 1)
// times that of one. False alarm 1e-6 for each k.
TEST(LazyCoordinates, MakeUpForEachStepTheyMissed) {
  for (const int missed : {0, 1, 5}) {
    Sample moves;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      LazyCoordinates state(step(Boundary::wrap));
      Stream random = stream(i);
      state.restart();
      state.propose(true, random);
      state.uniform();
      const double before = state.uniform();
      state.accept();
      for (int k = 0; k < missed; ++k) {
        state.propose(false, random);
        state.uniform();
        state.accept();
      }
      state.propose(false, random);
      state.uniform();
      const double move = state.uniform() - before;
      moves.values.push_back(move - std::round(move));
    }
    // E[step^2] = (s2^2 - s1^2) / (2 ln(s2 / s1)).
    const double one = (std::pow(SmallStep::largest, 2) - std::pow(SmallStep::smallest, 2)) /
                       (2 * std::log(SmallStep::largest / SmallStep::smallest));
    EXPECT_NEAR(moves.variance(), (missed + 1) * one, five * moves.variance_error()) << missed;
    EXPECT_NEAR(moves.mean(), 0, five * moves.mean_error());
  }
}

// A walk that accepts everything keeps coordinates uniform, at any time and for rare looks. Counts
// are in 32 cells after 30 steps of 20,000 chains, false alarm 1e-6 each.
TEST(LazyCoordinates, StayUniformWhereEverythingIsAccepted) {
  for (const Boundary boundary : {Boundary::wrap, Boundary::reflect, Boundary::reject}) {
    std::array<std::array<double, 32>, 3> counts{};
    constexpr int chains = 20000;
    for (std::uint64_t i = 0; i < chains; ++i) {
      LazyCoordinates state(step(boundary));
      Stream random = stream(i);
      state.restart();
      std::array<double, 3> last{};
      for (int k = 0; k < 30; ++k) {
        state.propose(k == 0 || random.uniform() < .1, random);
        std::array<double, 3> next = last;
        const std::size_t looked_at = k == 0 || k == 29 ? 3 : 1 + random() % 3;
        for (std::size_t c = 0; c < looked_at; ++c) next[c] = state.uniform();
        if (state.inside()) {
          state.accept();
          last = next;
        } else {
          state.reject();
        }
      }
      for (std::size_t c = 0; c < 3; ++c) ++counts[c][static_cast<std::size_t>(32 * last[c])];
    }
    for (const auto& cells : counts) EXPECT_TRUE(Pearson::of_equal(cells).passes());
  }
}

// Detailed balance at the stationary density 20 e^(-20 u) / (1 - e^-20): as many go from cell a to
// cell b in one step as back. Each pair's difference over the root of its sum is standard normal.
// Bowker's sum of squares is chi-square. False alarm 1e-6 each.
TEST(LazyCoordinates, OneStepFromTheStationaryLawIsInDetailedBalance) {
  for (const Boundary boundary : {Boundary::wrap, Boundary::reflect, Boundary::reject}) {
    std::array<std::array<double, 24>, 24> flow{};
    const auto cell = [](double u) { return static_cast<std::size_t>(std::min(23.0, u * 120)); };
    const MeanValueRules rules;
    for (std::uint64_t i = 0; i < 200000; ++i) {
      LazyCoordinates state(step(boundary));
      Stream random = stream(i);
      state.restart();
      double u = 0;
      do {  // rejection sampling of the stationary law
        state.propose(true, random);
        u = state.uniform();
        state.accept();
      } while (random.uniform() >= std::exp(-20 * u));
      state.propose(random.uniform() < .3, random);
      const double v = state.uniform();
      const double importance = state.inside() ? std::exp(-20 * v) : 0;
      if (random.uniform() < rules.acceptance(importance, std::exp(-20 * u))) {
        ++flow[cell(u)][cell(v)];
      }
    }
    double statistic = 0, freedom = 0;
    for (std::size_t a = 0; a < 24; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double sum = flow[a][b] + flow[b][a];
        if (sum < 40) continue;
        statistic += std::pow(flow[a][b] - flow[b][a], 2) / sum;
        ++freedom;
      }
    }
    ASSERT_GT(freedom, 30);
    EXPECT_LT(statistic, chi_square_bound(freedom));
  }
}

TEST(Rules, OfAStepAddUpToTheNormaliser) {
  const Contribution x{.pixel = 0, .value = Rgb::grey(2), .importance = 2};
  const Contribution y{.pixel = 1, .value = Rgb::grey(.5), .importance = .5};
  const MeanValueRules rules;
  EXPECT_EQ(rules.acceptance(.5, 2), .25);
  EXPECT_EQ(rules.acceptance(2, .5), 1);
  EXPECT_EQ(rules.acceptance(2, 0), 1);
  const Step one{x, y, .25, false, false, 3};
  const Weights mean_value = rules.weights(one);
  EXPECT_DOUBLE_EQ(mean_value.proposed * .5 + mean_value.current * 2, 3);
  const Weights small = MultipleImportanceRules(.5).weights(one);
  EXPECT_DOUBLE_EQ(small.proposed, .25 / (.5 / 3 + .5));
  EXPECT_DOUBLE_EQ(small.current, .75 / (2.0 / 3 + .5));
  const Step large{x, y, .25, true, true, 3};
  EXPECT_DOUBLE_EQ(MultipleImportanceRules(.5).weights(large).proposed, 1.25 / (.5 / 3 + .5));
}

}  // namespace
}  // namespace assay
