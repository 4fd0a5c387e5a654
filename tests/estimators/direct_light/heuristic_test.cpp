#include "direct_light/combination.h"
#include "tests/estimators/prelude.h"

namespace assay {
namespace {

using direct_light::Heuristic;
using direct_light::Pair;

const std::vector<Heuristic> all{Heuristic::balance(), Heuristic::power(2), Heuristic::power(3.5),
                                 Heuristic::cutoff(.2), Heuristic::maximum()};

TEST(Heuristic, WeightsSumToOneAndDoNotDependOnTheUnit) {
  for (const Heuristic& heuristic : all) {
    // A technique that cannot draw there weighs nothing.
    EXPECT_EQ(heuristic({0, 3}).light, 0);
    EXPECT_EQ(heuristic({3, 0}).brdf, 0);
    for (const double light : {0.0, 1e-12, .1, .3, 1.0, 7.0, 1e12}) {
      for (const double brdf : {1e-9, .3, 1.0, 50.0}) {
        const Pair w = heuristic({light, brdf});
        EXPECT_NEAR(w.light + w.brdf, 1, 1e-15);
        EXPECT_GE(w.light, 0);
        EXPECT_GE(w.brdf, 0);
        const Pair scaled = heuristic({1024 * light, 1024 * brdf});
        EXPECT_EQ(w.light, scaled.light);
      }
    }
  }
}

TEST(Heuristic, WeightsAreVeachs) {
  const auto light = [](const Heuristic& heuristic, double q) { return heuristic({q, 3}).light; };
  EXPECT_DOUBLE_EQ(light(Heuristic::balance(), 1), 1 / 4.0);
  EXPECT_DOUBLE_EQ(light(Heuristic::power(2), 1), 1 / 10.0);
  EXPECT_DOUBLE_EQ(light(Heuristic::power(3), 1), 1 / 28.0);
  EXPECT_DOUBLE_EQ(light(Heuristic::cutoff(.3), 1), 1 / 4.0);
  EXPECT_DOUBLE_EQ(light(Heuristic::cutoff(.4), 1), 0);
  EXPECT_DOUBLE_EQ(light(Heuristic::cutoff(.4), 9), 1);
  EXPECT_DOUBLE_EQ(light(Heuristic::maximum(), 1), 0);
  EXPECT_DOUBLE_EQ(light(Heuristic::maximum(), 4), 1);
  EXPECT_DOUBLE_EQ(light(Heuristic::maximum(), 3), 1);
  EXPECT_DOUBLE_EQ(light(Heuristic::power(7), 3), .5);
}

}  // namespace
}  // namespace assay
