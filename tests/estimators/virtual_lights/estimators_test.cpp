// Virtual lights and their mutants against closed forms and quadrature.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "render/vector.h"
#include "tests/estimators/draws.h"

namespace assay {
namespace {

using namespace assay::draws;
using render::Vector3;

const std::array<const char*, 6> walls = {
    "[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]", "[[0,0,1],[0,1,1],[1,1,1],[1,0,1]]",
    "[[0,1,0],[1,1,0],[1,1,1],[0,1,1]]", "[[0,0,0],[0,1,0],[0,1,1],[0,0,1]]",
    "[[1,0,0],[1,0,1],[1,1,1],[1,1,0]]", "[[0,0,0],[0,0,1],[1,0,1],[1,0,0]]"};

struct Cube {
  bool even = true;  ///< all walls emit, or the ceiling alone
  std::string camera = "0.5, 0.5";
  std::size_t sides = 6;
  std::string albedo = "0.5";
};

// A cube of albedo 0.5, its floor seen from straight above, and more parameters.
std::string in(const Cube& cube, const std::string& more = "") {
  std::string text =
      "{scene: {camera: {position: [" + cube.camera + ", 0.5], direction: [0, 0, -1]}, surfaces: [";
  for (std::size_t i = 0; i < cube.sides; ++i) {
    text += std::string(i ? ", " : "") + "{polygon: " + walls[i] +
            ", emission: " + (cube.even || i == 1 ? "1" : "0") + ", albedo: " + cube.albedo + "}";
  }
  return text + "]}" + more + "}";
}

const Cube even;
const Cube ceiling{.even = false};

// By scipy's dblquad over the walls of cos cos' / (pi r^2) times the ceiling's form factor, to
// 1e-9.
constexpr double from_ceiling = 0.034688115863786444;
constexpr double form_factor_of_ceiling = 0.2394564704607735;

// False-alarm rate 1e-6 each.
TEST(VirtualLights, UnbiasedOnesAgreeWithClosedForms) {
  struct Case {
    const char* plugin;
    std::string parameters;
    double mean;
  };
  for (const auto& [name, parameters, mean] :
       {Case{"virtual_lights/classic", in(even), 0.25},
        {"virtual_lights/classic", in(ceiling), from_ceiling},
        {"virtual_lights/gather", in(ceiling), from_ceiling},
        // a^2 Le.
        {"virtual_lights/classic", in({.albedo = "0.3"}), 0.09}}) {
    const Sample sample = observe(prepare(name, parameters), 20000, 16)[0];
    EXPECT_NEAR(sample.mean(), mean, five * sample.mean_error() + 1e-4 * mean) << name;
  }
}

TEST(VirtualLights, ColoursHaveAChannelEach) {
  const auto plugin = prepare("virtual_lights/weighted",
                              in({.albedo = "[0.2, 0.4, 0.6]"}, ", weighting: marginal"));
  const auto channels = plugin.setup->channels();
  const auto samples = observe(plugin, 10, 16);
  ASSERT_EQ(channels.size(), 4u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(*channels[c].mean, std::pow(0.2 * static_cast<double>(c + 1), 2), 1e-15);
    for (const double x : samples[c].values) EXPECT_NEAR(x, *channels[c].mean, 1e-12);
  }
}

TEST(VirtualLights, TheTargetsIntegralIsThatOfWhatCanBeShotAt) {
  const auto integral = [](const Cube& cube, const char* weighting) {
    const auto plugin =
        prepare("virtual_lights/weighted", in(cube, std::string(", weighting: ") + weighting));
    return plugin.setup->channels()[1].mean.value();
  };
  // Rays start 2e-5 above the floor.
  EXPECT_NEAR(integral(even, "conditional"), 5. / 6, 1e-4);
  EXPECT_DOUBLE_EQ(integral(even, "marginal"), 1);
  EXPECT_NEAR(integral(ceiling, "conditional"), 1 - form_factor_of_ceiling, 1e-4);
  EXPECT_NEAR(integral(ceiling, "marginal"), 1 - form_factor_of_ceiling, 1e-4);
}

// False-alarm rate 1e-6 each: the mean of g / p is G, the estimate near the answer.
TEST(VirtualLights, WeightedOnesAreConsistent) {
  const auto plugin = prepare("virtual_lights/weighted", in(ceiling, ", weighting: marginal"));
  const auto samples = observe(plugin, 500, 2048);
  EXPECT_NEAR(samples[1].mean(), 1 - form_factor_of_ceiling, five * samples[1].mean_error() + 1e-4);
  EXPECT_NEAR(samples[0].mean(), from_ceiling,
              five * samples[0].mean_error() + 1e-3 * from_ceiling);
}

TEST(VirtualLights, ByTheMarginalDensityEvenEmissionGivesAConstant) {
  for (const char* camera : {"0.5, 0.5", "0.005, 0.005"}) {
    const auto plugin =
        prepare("virtual_lights/weighted", in({.camera = camera}, ", weighting: marginal"));
    const Sample sample = observe(plugin, 50, 16)[0];
    for (const double x : sample.values) EXPECT_NEAR(x, 0.25, 1e-13);
  }
}

TEST(VirtualLights, AFurnaceOfAnyShapeHasTheSquareOfItsAlbedo) {
  const auto plugin = prepare(
      "virtual_lights/weighted",
      "{scene: {camera: {position: [1.6, .5, .5], direction: [0, 0, -1]}, furnace: {obj: room.obj, "
      "emission: 2, albedo: .6}}, weighting: marginal}",
      ASSAY_SOURCE_DIR "/suites/data");
  EXPECT_DOUBLE_EQ(*plugin.setup->channels()[0].mean, 2 * 0.36);
  EXPECT_EQ(*plugin.setup->channels()[1].mean, 1);
  const Sample sample = observe(plugin, 20, 64)[0];
  for (const double x : sample.values) EXPECT_NEAR(x, 0.72, 1e-12);
}

// A box of the given sides about a centre, turned by an angle about (1, 2, 3), whose walls all emit
// 1 and reflect 0.5, with what its camera in the middle sees of it.
std::string turned_box(const Vector3& centre, const Vector3& sides, double angle) {
  const Vector3 axis = render::normalised({1, 2, 3});
  const auto written = [](const Vector3& v) {
    char text[96];
    std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", v.x, v.y, v.z);
    return std::string(text);
  };
  const auto turned = [&](const Vector3& v) {  // Rodrigues
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
           (1 - std::cos(angle)) * dot(axis, v) * axis;
  };
  const auto corner = [&](int i) {
    return written(centre + turned({((i & 1) - 0.5) * sides.x, ((i >> 1 & 1) - 0.5) * sides.y,
                                    ((i >> 2 & 1) - 0.5) * sides.z}));
  };
  std::string text = "{scene: {camera: {position: " + written(centre) +
                     ", direction: " + written(turned({0.1, 0.05, -1})) + "}, surfaces: [";
  const char* separator = "";
  for (const auto& [a, b, c, d] : {std::array{0, 1, 3, 2},
                                   {4, 6, 7, 5},
                                   {2, 3, 7, 6},
                                   {0, 2, 6, 4},
                                   {1, 5, 7, 3},
                                   {0, 4, 5, 1}}) {
    text += std::string(separator) + "{polygon: [" + corner(a) + ", " + corner(b) + ", " +
            corner(c) + ", " + corner(d) + "], emission: 1, albedo: 0.5}";
    separator = ", ";
  }
  return text + "]}, weighting: marginal}";
}

TEST(VirtualLights, ABoxIsClosedWhereverItStandsAndHoweverItIsTurned) {
  for (int i = 0; i < 40; ++i) {
    const Vector3 centre = {0.1 * i, 7.3 - 0.7 * i, 0.3};
    for (const double angle : {0., 0.37 * i}) {
      const Vector3 sides = {1.1, 0.7 + 0.1 * i, 0.9};
      const auto plugin = prepare("virtual_lights/weighted", turned_box(centre, sides, angle));
      const auto channels = plugin.setup->channels();
      EXPECT_EQ(channels[0].mean, 0.25) << i << " " << angle;
      EXPECT_EQ(channels[1].mean, 1) << i << " " << angle;
    }
  }
}

TEST(VirtualLights, AGivenIntegralScalesTheEstimate) {
  auto one = prepare("virtual_lights/weighted", in(ceiling, ", target_integral: 1"));
  const auto half = prepare("virtual_lights/weighted", in(ceiling, ", target_integral: 0.5"));
  one.key = half.key;
  const Sample a = observe(one, 20, 16)[0];
  const Sample b = observe(half, 20, 16)[0];
  for (std::size_t i = 0; i < 20; ++i) EXPECT_DOUBLE_EQ(a.values[i], 2 * b.values[i]);
}

std::string refusal(const std::string& plugin, const std::string& parameters) {
  try {
    prepare(plugin, parameters);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(VirtualLights, BadInputIsRefusedByNameAndReason) {
  using testing::AllOf;
  using testing::HasSubstr;
  const std::string weighted = "virtual_lights/weighted";
  EXPECT_THAT(refusal(weighted, in({.sides = 5})),
              AllOf(HasSubstr("target_integral"), HasSubstr("this one is open"),
                    HasSubstr("belongs to one triangle only")));
  EXPECT_THAT(refusal(weighted, in({.even = false, .sides = 5}, ", weighting: marginal")),
              AllOf(HasSubstr("weighting"), HasSubstr("belongs to one triangle only")));
  EXPECT_THAT(refusal(weighted, in(even, ", target_integral: 0")),
              AllOf(HasSubstr("target_integral"), HasSubstr("at most 1")));
  EXPECT_THAT(refusal(weighted, in(even, ", target_integral: 1.2")), HasSubstr("at most 1"));
  EXPECT_THAT(refusal(weighted, "{scene: box}"), HasSubstr("target_integral"));
  EXPECT_THAT(refusal(weighted, "{scene: sphere}"), HasSubstr("need triangles"));
  EXPECT_THAT(refusal("virtual_lights/classic", in({.albedo = "1"})), HasSubstr("below 1"));
  EXPECT_THAT(refusal("virtual_lights/classic", in({.albedo = "0"})), HasSubstr("albedo 0"));
  EXPECT_THAT(refusal("virtual_lights/classic",
                      "{scene: {camera: {position: [.5, .5, .5], direction: [0, 0, -1]}, surfaces: "
                      "[{polygon: [[0,0,0],[1,0,0],[1,1,0]], emission: 0, albedo: .5}]}}"),
              HasSubstr("no surface emits"));
}

// 1 / G - 1 whatever M.
TEST(VirtualLightsMutants, TheTargetsIntegralTakenForOneIsOffByItsInverse) {
  for (const Cube& cube : {even, ceiling}) {
    const auto broken = prepare("mutants/target_integral_one", in(cube));
    const auto sound = prepare("virtual_lights/weighted", in(cube));
    const double g = *sound.setup->channels()[1].mean;
    ASSERT_EQ(broken.key, sound.key);
    const Sample a = observe(broken, 20, 64)[0];
    const Sample b = observe(sound, 20, 64)[0];
    for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(a.values[i], b.values[i] / g, 1e-12);
  }
}

// False-alarm rate 1e-6 each.
TEST(VirtualLightsMutants, MissByWhatTheirDefectSays) {
  struct Case {
    const char* mutant;
    std::string parameters;
    double low, high;  // of the relative bias
  };
  for (const auto& [name, parameters, low, high] :
       {Case{"mutants/power_not_divided", in(even), 15, 15},
        // From its middle all walls are half a side away and more.
        {"mutants/clamped_distance", in(even, ", least_distance: 0.4"), 0, 0},
        {"mutants/clamped_distance", in({.camera = "0.005, 0.005"}), -0.75, -0.6},
        {"mutants/target_of_other_paths", in(even, ", weighting: marginal"), 0.01, 0.2}}) {
    const auto plugin = prepare(name, parameters);
    const Sample sample = observe(plugin, 4000, 16)[0];
    const double mean = *plugin.setup->channels()[0].mean;
    const double error = five * sample.mean_error() / mean;
    EXPECT_GT(sample.mean() / mean - 1, low - error) << name;
    EXPECT_LT(sample.mean() / mean - 1, high + error) << name;
  }
}

TEST(VirtualLightsMutants, TheUnhiddenTargetIsTheOriginalInAConvexRoom) {
  const auto broken = prepare("mutants/target_unhidden", in(ceiling));
  const auto sound = prepare("virtual_lights/weighted", in(ceiling));
  EXPECT_EQ(observe(broken, 200, 16)[0].values, observe(sound, 200, 16)[0].values);
}

// M times the bias tends to I Var g - Cov(f, g) = -0.50012, without the jackknife's share to
// -Cov(f, g) = -3.53503; the mean of f / g is 5.960054 (scipy's quad). False-alarm rate 1e-6 each.
TEST(Ratio, MutantsHaveTheBiasOfTheirDefect) {
  struct Case {
    const char* plugin;
    double bias;
    double rest;  // of terms 1 / M^2 and higher
  };
  constexpr double integral = 6.361845641;
  for (const auto& [name, bias, rest] : {Case{"analytic/ratio", -0.50012 / 16, 0.002},
                                         {"analytic/jackknifed_ratio", 0, 0.004},
                                         {"mutants/ratio_of_other_points", 3.03491 / 16, 0.03},
                                         {"mutants/mean_of_ratios", 5.960054 - integral, 0},
                                         {"mutants/jackknifed_numerator", -0.50012 / 16, 0.002},
                                         {"mutants/jackknifed_denominator", -3.53503 / 16, 0.03}}) {
    const Sample sample = observe(prepare(name), 200000, 16)[0];
    EXPECT_NEAR(sample.mean() - integral, bias, five * sample.mean_error() + rest) << name;
  }
}

TEST(Ratio, OnePointLeavesNothingToLeaveOut) {
  auto jackknifed = prepare("analytic/jackknifed_ratio");
  const auto plain = prepare("analytic/ratio");
  jackknifed.key = plain.key;
  EXPECT_EQ(observe(jackknifed, 20)[0].values, observe(plain, 20)[0].values);
}

}  // namespace
}  // namespace assay
