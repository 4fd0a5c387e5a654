#include "paths/zone_law.h"

#include "tests/prelude.h"

namespace assay::paths {
namespace {

// A furnace of albedo 0.6 and emission 1 with survival by albedo: L = 2.5, the classical variance
// a / (1 - a)^2 = 3.75, with terminal value kappa a L (1 - kappa)^2 times that.
TEST(ZoneLaw, FurnaceHasTheVarianceOfAGeometricNumberOfVertices) {
  for (const auto& [kappa, expected] :
       {std::pair{0.0, 3.75}, {0.5, 0.9375}, {0.9, 0.0375}, {1.0, 0.0}, {2.0, 3.75}}) {
    const std::vector<ZoneSteps> zones = {
        {.fraction = 1, .albedo = 0.6, .survival = 0.6, .terminal = kappa * 0.6 * 2.5, .score = 1}};
    EXPECT_DOUBLE_EQ(moments(zones).mean, 2.5);
    EXPECT_NEAR(path_variance(zones, 0, 1).value(), expected, 1e-13) << kappa;
  }
}

// (1 - q) a^2 L^2 / (q - a^2) for a constant probability q; infinite from q = a^2 down.
TEST(ZoneLaw, VarianceOfConstantSurvivalIsInfiniteFromTheSquareOfTheAlbedoDown) {
  std::vector<ZoneSteps> zones = {{.fraction = 1, .albedo = 0.5, .survival = 0.8, .score = 1}};
  EXPECT_NEAR(path_variance(zones, 0, 1).value(), 0.2 * 0.25 * 4 / (0.8 - 0.25), 1e-14);
  zones[0].survival = 0.25;
  EXPECT_EQ(path_variance(zones, 0, 1), std::nullopt);
  zones[0].survival = 0.2;
  EXPECT_EQ(path_variance(zones, 0, 1), std::nullopt);
}

// Two zones of a half each: emission 1 and 0, albedo 0.2 and 0.6, analogue roulette. The mean of L
// is 0.5 / 0.6; S = E[X^2] solves S = E[Le^2 + 2 Le a mu] + E[a] S = 0.5 (1 + 0.4 mu) + 0.4 S.
TEST(ZoneLaw, TwoZonesSolveTheirEquation) {
  const std::vector<ZoneSteps> zones = {
      {.fraction = 0.5, .albedo = 0.2, .survival = 0.2, .score = 1},
      {.fraction = 0.5, .albedo = 0.6, .survival = 0.6, .score = 0}};
  const double mean = 0.5 / 0.6;
  const double square = 0.5 * (1 + 0.4 * mean) / 0.6;
  EXPECT_DOUBLE_EQ(moments(zones).mean, mean);
  EXPECT_DOUBLE_EQ(moments(zones).square.value(), square);
  // From the dark zone: X = B X', B of mean 0.6.
  EXPECT_DOUBLE_EQ(path_variance(zones, 1, 1).value(), 0.6 * square - 0.36 * mean * mean);
}

// N = floor(n + u) children of weight a / n: (n Var X' + r (1 - r) mu^2) (a / n)^2.
TEST(ZoneLaw, SplittingDividesTheVarianceOfTheChildren) {
  const std::vector<ZoneSteps> zones = {
      {.fraction = 1, .albedo = 0.5, .survival = 0.5, .score = 1}};
  // Var X' = 2, mu = 2; n = 2 children of weight 1/4, and n = 2.5 of weight 1/5.
  EXPECT_DOUBLE_EQ(path_variance(zones, 0, 4).value(), 2 * 2 / 16.0);
  EXPECT_DOUBLE_EQ(path_variance(zones, 0, 5).value(), (2.5 * 2 + 0.25 * 4) / 25);
}

TEST(ZoneLaw, SeenRadianceIsEmissionAndReflectedMean) {
  const ZonedScene scene{
      {{0.9, {{}, Rgb::grey(0.8), {}}}, {0.1, {Rgb::grey(1), Rgb::grey(0.8), {}}}}, 0};
  EXPECT_DOUBLE_EQ(scene.mean_radiance()[0], 0.5);
  EXPECT_DOUBLE_EQ(scene.seen_radiance()[0], 0.4);
}

}  // namespace
}  // namespace assay::paths
