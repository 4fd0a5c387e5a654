#include "render/environment_map.h"
#include "tests/estimators/prelude.h"
#include "tests/estimators/sky.h"

namespace assay {
namespace {

using render::EnvironmentMap;
using render::Patch;
using render::Rgb;
using render::Vector3;

const EnvironmentMap& sky_map() {
  static const EnvironmentMap map = render::read_environment(suite_data + "/sky.exr");
  return map;
}

Prepared sky_plugin(const std::string& plugin, const std::string& more = "") {
  return prepare("environment/" + plugin, "{map: sky.exr" + more + "}");
}

TEST(Environment, TheSharedPictureIsWhatItsProgramMakes) {
  const EnvironmentMap& map = sky_map();
  ASSERT_EQ(map.resolution().width, sky_width);
  ASSERT_EQ(map.resolution().height, sky_height);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto texel = sky_texel(i / sky_width, i % sky_width);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(map.radiance(i)[c] / double{texel[c]}, 1, 1e-6);
    }
  }
}

TEST(Environment, BothEstimatorsHaveOneMean) {
  const auto a = sky_plugin("cosine").setup->channels();
  const auto b = sky_plugin("emittance").setup->channels();
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(a[c].mean, b[c].mean);
    EXPECT_LT(a[c].mean_error, 1e-9 * *a[c].mean);
    EXPECT_LT(*b[c].variance, *a[c].variance) << "the sun is where emittance sampling looks";
  }
  EXPECT_EQ(a[0].name, "r");
  EXPECT_EQ(a[2].name, "b");
}

// A wall at x = -0.001 hides w_x < 0 but for a millionth. The sum over the texels with w_x > 0 is
// left; their columns end at the wall. Single precision rays. False alarm: 6 at 1e-6.
TEST(Environment, AWallHidesHalfTheSky) {
  const EnvironmentMap& map = sky_map();
  Rgb expected{};
  for (std::size_t i = 0; i < map.size(); ++i) {
    const std::size_t column = i % sky_width;
    if (column >= sky_width / 4 && column < 3 * sky_width / 4) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      expected[c] += map.radiance(i)[c] * cosine_moments(map.patch(i), {0, 0, 1}).first;
    }
  }
  const std::string wall =
      ", position: [5, 6, 7], occluders: [{polygon: [[4.999, -994, -993], [4.999, 1006, -993], "
      "[4.999, 1006, 1007], [4.999, -994, 1007]]}]";
  for (const char* name : {"cosine", "emittance"}) {
    const auto plugin = sky_plugin(name, wall);
    const auto samples = observe(plugin, 200000);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_FALSE(plugin.channel(c).mean.has_value());
      EXPECT_THAT(samples[c], HasMean(expected[c], 1e-5 * expected[c])) << name;
    }
  }
}

// S6: L = 1 + bx wx + bz wz with the half w_x > 0 gives pi/2 + (2/3) bx + (pi/3) bz. Texels at
// their middle's radiance differ by some h^2.
TEST(Environment, GradientSkyApproachesItsClosedForm) {
  const double bx = 0.3, bz = 0.2;
  const EnvironmentMap map({.width = 512, .height = 256}, std::vector<Rgb>(512 * 256));
  double half = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Patch p = map.patch(i);
    const double theta = (p.theta[0] + p.theta[1]) / 2, phi = (p.phi[0] + p.phi[1]) / 2;
    const double x = std::sin(theta) * std::cos(phi);
    if (x > 0) half += (1 + bx * x + bz * std::cos(theta)) * cosine_moments(p, {0, 0, 1}).first;
  }
  EXPECT_NEAR(half, pi / 2 + 2 * bx / 3 + pi * bz / 3, 2e-5);
}

// False alarm 2e-6. Cells are 2 x 2 texels; the emittance sampler is uniform within a texel.
TEST(Environment, EmittanceDirectionsFollowTheirDensity) {
  const auto plugin = sky_plugin("emittance");
  const auto sampler = plugin.sampler();
  EXPECT_EQ(sampler->domain(), Domain::sphere);
  const EnvironmentMap& map = sky_map();
  // Quarters of texels.
  std::vector<double> counts(4 * map.size());
  constexpr int draws = 400000;
  for (std::uint64_t i = 0; i < draws; ++i) {
    Stream random(plugin.key, i);
    const SamplerDraw draw = sampler->sample(random);
    ASSERT_TRUE(draw.valid);
    const Vector3 w{draw.point[0], draw.point[1], draw.point[2]};
    const std::size_t texel = map.texel(w);
    const Patch p = map.patch(texel);
    const bool lower = w.z < (std::cos(p.theta[0]) + std::cos(p.theta[1])) / 2;
    const double phi = std::atan2(w.y, w.x);
    const bool later = (phi < 0 ? phi + 2 * pi : phi) > (p.phi[0] + p.phi[1]) / 2;
    counts[4 * texel + (lower ? 2 : 0) + (later ? 1 : 0)] += 1;
    EXPECT_NEAR(draw.weight * draw.density, sampler->evaluate(draw.point), 1e-9);
  }
  double total = 0;
  std::vector<double> power;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto l = sky_texel(i / sky_width, i % sky_width);
    const Patch p = map.patch(i);
    power.push_back(double{l[0] + l[1] + l[2]} * (p.phi[1] - p.phi[0]) *
                    (std::cos(p.theta[0]) - std::cos(p.theta[1])));
    total += power.back();
  }
  Pearson pearson;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    pearson.add(counts[i], draws * power[i / 4] / total / 4);
  }
  EXPECT_TRUE(pearson.passes()) << pearson.statistic;
}

// False alarm 1e-6. Cells of equal probability: z^2 is uniform.
TEST(Environment, CosineDirectionsFollowTheirDensity) {
  const auto plugin = sky_plugin("cosine", ", normal: [1, 1, 0]");
  const auto sampler = plugin.sampler();
  EXPECT_EQ(sampler->domain(), Domain::hemisphere);
  std::vector<double> counts(256);
  constexpr int draws = 100000;
  for (std::uint64_t i = 0; i < draws; ++i) {
    Stream random(plugin.key, i);
    const SamplerDraw draw = sampler->sample(random);
    const double turn = std::atan2(draw.point[1], draw.point[0]) / (2 * pi);
    const double row = std::min(15.0, std::floor(16 * draw.point[2] * draw.point[2]));
    const double column = std::min(15.0, std::floor(16 * (turn < 0 ? turn + 1 : turn)));
    counts[static_cast<std::size_t>(16 * row + column)] += 1;
    EXPECT_NEAR(draw.density, draw.point[2] / pi, 1e-15);
    EXPECT_NEAR(draw.weight * draw.density, sampler->evaluate(draw.point), 1e-12);
  }
  EXPECT_TRUE(Pearson::of_equal(counts).passes());
}

}  // namespace
}  // namespace assay
