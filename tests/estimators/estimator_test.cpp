#include "estimators/estimator.h"

#include "tests/prelude.h"

namespace assay {
namespace {

struct OneStep {
  double operator()(Stream& random, Cost& cost) const {
    ++cost.shadow_rays;
    return random.uniform() - 2 * random.uniform();
  }
};

struct TwoStep {
  std::array<double, 2> draw(Stream& random) const {
    const double x = random.uniform();
    return {x, random.uniform()};
  }
  double value(const std::array<double, 2>& choices, Cost& cost) const {
    ++cost.shadow_rays;
    return choices[0] - 2 * choices[1];
  }
};

double secondary(auto& average, std::uint64_t primaries, Cost& cost) {
  Stream random({1}, 5);
  double out = 0;
  average(random, primaries, {&out, 1}, cost);
  return out;
}

TEST(Averaging, IsTheMeanOfItsPrimaries) {
  Averaging<OneStep> average;
  Stream random({1}, 5);
  Cost ignored;
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += OneStep{}(random, ignored);
  Cost cost;
  EXPECT_EQ(secondary(average, 3, cost), sum / 3);
  EXPECT_EQ(cost, (Cost{.shadow_rays = 3, .samples = 3}));
}

TEST(Averaging, TwoStepsGiveTheNumbersOfOneWhateverTheBatch) {
  Averaging<OneStep> one;
  Averaging<TwoStep> two;
  for (const std::uint64_t primaries : {1u, 2u, 31u, 32u, 33u, 64u, 1000u}) {
    Cost cost_one;
    Cost cost_two;
    EXPECT_EQ(secondary(one, primaries, cost_one), secondary(two, primaries, cost_two));
    EXPECT_EQ(cost_one, cost_two);
  }
}

TEST(Averaging, NothingLeaksFromOneObservationToTheNext) {
  Averaging<TwoStep> average;
  Cost cost;
  const double before = secondary(average, 7, cost);
  secondary(average, 40, cost);
  EXPECT_EQ(secondary(average, 7, cost), before);
}

TEST(AveragingSetup, GivesWhatItWasMadeFrom) {
  const auto setup = averaging(Channel{.name = "x", .mean = 2}, OneStep{});
  ASSERT_EQ(setup->channels().size(), 1u);
  EXPECT_EQ(setup->channels()[0].mean, 2);
  EXPECT_TRUE(setup->samplers().empty());
  EXPECT_FALSE(setup->observations().has_value());
}

}  // namespace
}  // namespace assay
