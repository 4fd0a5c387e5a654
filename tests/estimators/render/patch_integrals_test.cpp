#include "render/environment_map.h"
#include "tests/prelude.h"

namespace assay {
namespace {

using render::EnvironmentMap;
using render::Patch;
using render::Rgb;
using render::Vector3;

// Midpoint sums of max(0, n.w)^k over a patch.
std::array<double, 2> brute_force(const Patch& patch, const Vector3& n) {
  constexpr int steps = 1200;
  std::array<double, 2> sum{};
  const double dt = (patch.theta[1] - patch.theta[0]) / steps;
  const double dp = (patch.phi[1] - patch.phi[0]) / steps;
  for (int i = 0; i < steps; ++i) {
    const double theta = patch.theta[0] + (i + 0.5) * dt;
    for (int j = 0; j < steps; ++j) {
      const double phi = patch.phi[0] + (j + 0.5) * dp;
      const double cosine =
          std::max(0.0, n.x * std::sin(theta) * std::cos(phi) +
                            n.y * std::sin(theta) * std::sin(phi) + n.z * std::cos(theta));
      sum[0] += cosine * std::sin(theta) * dt * dp;
      sum[1] += cosine * cosine * std::sin(theta) * dt * dp;
    }
  }
  return sum;
}

TEST(PatchIntegrals, AgreeWithBruteForceSums) {
  const std::vector<Patch> patches{{{0, 0.4}, {0, 0.5}},
                                   {{0.3, 0.5}, {1, 1.2}},
                                   {{1.2, 1.9}, {5.5, 6.2}},
                                   {{2.8, pi}, {0, 2 * pi}},
                                   {{0, pi}, {0, 2 * pi}}};
  for (const Vector3& n :
       {Vector3{0, 0, 1}, Vector3{0, 0, -1}, Vector3{1, 0, 0}, normalised(Vector3{0.3, -0.5, 0.8}),
        normalised(Vector3{-1, 1, -0.01}), normalised(Vector3{0.2, 0.9, -0.7})}) {
    for (const Patch& patch : patches) {
      const auto exact = cosine_moments(patch, n);
      const auto brute = brute_force(patch, n);
      // The midpoint rule leaves some h^2 of the integral: 1e-5 for the whole sphere.
      EXPECT_NEAR(exact.first, brute[0], 1e-5);
      EXPECT_NEAR(exact.second, brute[1], 1e-5);
      EXPECT_LT(exact.error, 1e-11);
    }
  }
}

// Over any division of the sphere the first moments sum to pi, the second to 2 pi / 3.
TEST(PatchIntegrals, AddUpToTheHemisphere) {
  const EnvironmentMap map({.width = 48, .height = 25}, std::vector<Rgb>(48 * 25));
  for (const Vector3& n : {Vector3{0, 0, 1}, Vector3{0, -1, 0}, normalised(Vector3{0.3, -0.5, 0.8}),
                           normalised(Vector3{1, 2, -1e-3})}) {
    double first = 0, second = 0, error = 0, angle = 0;
    for (std::size_t texel = 0; texel < map.size(); ++texel) {
      const auto moments = cosine_moments(map.patch(texel), n);
      first += moments.first;
      second += moments.second;
      error += moments.error;
      angle += solid_angle(map.patch(texel));
    }
    EXPECT_NEAR(angle, 4 * pi, 1e-12);
    EXPECT_NEAR(first, pi, 1e-11);
    EXPECT_NEAR(second, 2 * pi / 3, 1e-11);
    EXPECT_LT(error, 1e-11);
  }
}

TEST(EnvironmentMap, FindsTheTexelOfADirectionDrawnInIt) {
  const EnvironmentMap map({.width = 6, .height = 5}, std::vector<Rgb>(30));
  for (std::size_t texel = 0; texel < map.size(); ++texel) {
    for (const double u : {0.001, 0.5, 0.999}) {
      for (const double v : {0.001, 0.5, 0.999}) {
        EXPECT_EQ(map.texel(direction_in(map.patch(texel), {u, v})), texel);
      }
    }
  }
  EXPECT_EQ(map.texel({0, 0, 1}), 0u);
  EXPECT_EQ(map.texel({0, 0, -1}) / 6, 4u);
  EXPECT_EQ(map.texel({1, -1e-300, 0}) % 6, 5u) << "just below a full turn is the last column";
}

TEST(EnvironmentMap, RefusesWhatIsNoRadiance) {
  EXPECT_THROW(EnvironmentMap({.width = 0, .height = 0}, {}), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap({.width = 2, .height = 1}, {{1, 1, 1}}), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap({.width = 1, .height = 1}, {{1, -1, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace assay
