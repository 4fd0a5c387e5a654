// Virtual lights and their mutants against closed forms and quadrature.

#include "render/vector.h"
#include "tests/estimators/draws.h"
#include "tests/estimators/table.h"
#include "tests/prelude.h"

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

// A number of tests/tables/virtual_lights.csv, which is good to 1e-9 (1e-5 where distances are
// clamped).
double tabulated(const std::string& what) {
  for (const auto& row : tests::table("virtual_lights.csv")) {
    if (row[0] == what) return std::stod(row[1]);
  }
  throw std::runtime_error("no " + what);
}

const double from_ceiling = tabulated("radiance_from_ceiling");
const double form_factor_of_ceiling = tabulated("ceiling");

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

// A lobe of the same albedo in a room of even light reflects what a diffuse one does. False-alarm
// rate 1e-6 each.
TEST(VirtualLights, AGlossyReceiverInEvenLightIsAsBright) {
  for (const char* plugin : {"virtual_lights/classic", "virtual_lights/gather"}) {
    for (const char* shininess : {"3", "60"}) {
      const auto prepared = prepare(plugin, in(even, std::string(", shininess: ") + shininess));
      EXPECT_DOUBLE_EQ(*prepared.setup->channels()[0].mean, 0.25);
      const Sample sample = observe(prepared, 20000, 16)[0];
      EXPECT_NEAR(sample.mean(), 0.25, five * sample.mean_error() + 1e-4) << plugin << shininess;
    }
  }
  const Sample weighted = observe(
      prepare("virtual_lights/weighted", in(even, ", shininess: 60, weighting: marginal")), 50)[0];
  int lit = 0;
  for (const double x : weighted.values) {
    if (x == 0) continue;  // the light was on the floor
    ++lit;
    EXPECT_NEAR(x, 0.25, 1e-13);
  }
  // The floor has a sixth of the area; that it has half of 50 lights is rarer than 1e-7.
  EXPECT_GT(lit, 25);
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
  // The receiver is moved by 2^-14 of the way to the middle of its triangle.
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

// A box of the given sides about a centre, turned by an angle about (1, 2, 3). Its walls all emit 1
// and reflect 0.5. The camera is in the middle.
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

// To rounding, observation by observation.
TEST(VirtualLightsMutants, PowerNotDividedIsTheOriginalTimesTheNumberOfLights) {
  const Sample a = observe(prepare("mutants/power_not_divided", in(ceiling)), 50, 16)[0];
  const Sample b = observe(prepare("virtual_lights/classic", in(ceiling)), 50, 16)[0];
  for (std::size_t i = 0; i < 50; ++i) EXPECT_DOUBLE_EQ(a.values[i], 16 * b.values[i]);
}

// From the middle of the floor all other walls are half a side away and more.
TEST(VirtualLightsMutants, WhereNothingIsNearNoDistanceIsClamped) {
  const auto sound = prepare("virtual_lights/classic", in(even));
  auto clamped = prepare("mutants/clamped_distance", in(even, ", least_distance: 0.49"));
  ASSERT_EQ(clamped.key, sound.key);
  const Sample a = observe(clamped, 200, 16)[0];
  const Sample b = observe(sound, 200, 16)[0];
  for (std::size_t i = 0; i < 200; ++i) EXPECT_DOUBLE_EQ(a.values[i], b.values[i]);
}

// A form factor with no distance below `least_distance`. The corner's receiver is moved by 0.4 % of
// its distance to the walls, which changes the near light by as much. False-alarm rate 1e-6 each.
TEST(VirtualLightsMutants, AClampedDistanceLosesTheLightOfTheCorner) {
  for (const char* least : {"0.1", "0.3"}) {
    const double kept = tabulated(std::string("clamped_") + least + "_in_corner");
    const Sample sample =
        observe(prepare("mutants/clamped_distance",
                        in({.camera = "0.005, 0.005"}, std::string(", least_distance: ") + least)),
                4000, 64)[0];
    EXPECT_NEAR(sample.mean(), 0.25 * kept, five * sample.mean_error() + 0.001 * kept) << least;
  }
}

// By E[S] E[1/S] of independent sums of g / p, f being in proportion to g. False-alarm rate 1e-6.
TEST(VirtualLightsMutants, TheTargetOfOtherPathsLeavesTheMeanOfAQuotient) {
  const auto plugin = prepare("mutants/target_of_other_paths", in(even, ", weighting: marginal"));
  for (const int count : {8, 16}) {
    const double bias = tabulated("other_paths_" + std::to_string(count));
    const Sample sample = observe(plugin, 20000, static_cast<std::uint64_t>(count))[0];
    EXPECT_NEAR(sample.mean() / 0.25 - 1, bias, five * sample.mean_error() / 0.25 + 1e-3) << count;
  }
}

// The terms in place of g / p have this mean, so that the estimate tends to 0.25 x 5/6 of its
// inverse. Its variance is infinite, by a logarithm, but the mean of a million values is normal.
// False-alarm rate 1e-6 each.
TEST(VirtualLightsMutants, ADensityOfDirectionsTendsToSomethingElse) {
  const auto samples = observe(prepare("mutants/density_of_direction", in(even)), 500, 2048);
  const double target = tabulated("density_of_direction_target");
  EXPECT_NEAR(samples[1].mean(), target, five * samples[1].mean_error() + 1e-3);
  const double limit = 0.25 * 5 / 6 / target;
  EXPECT_NEAR(samples[0].mean(), limit, five * samples[0].mean_error() + 1e-2 * limit);
}

// The density of the virtual light in units of power, a^2 A F, is f / g. The limit is its mean
// among lights that are seen. Consistent to 1 / M of the chance that none is. False-alarm rate
// 1e-6.
TEST(VirtualLightsMutants, TheMeanOfRatiosIsThatOfTheDensity) {
  const auto plugin = prepare("mutants/mean_of_weights", in(ceiling, ", weighting: marginal"));
  const Sample sample = observe(plugin, 4000, 64)[0];
  const double mean = tabulated("mean_of_weights");
  EXPECT_NEAR(sample.mean(), mean, five * sample.mean_error() + 1e-3 * mean);
}

// Since f / g is constant, the limit is the answer over a sum of form factors. It is over all faces
// that are turned to the receiver, hidden or not. M = 1024 is off by 1 / M. False-alarm rate 1e-6.
TEST(VirtualLightsMutants, AnUnhiddenTargetDividesByWhatIsHiddenToo) {
  const auto plugin = prepare(
      "mutants/target_unhidden",
      "{scene: {camera: {position: [1.6, .5, .5], direction: [0, 0, -1]}, furnace: {obj: room.obj, "
      "emission: 1, albedo: .5}}, weighting: marginal}",
      ASSAY_SOURCE_DIR "/suites/data");
  const auto samples = observe(plugin, 1000, 1024);
  const double all = tabulated("unhidden_in_corridor");
  EXPECT_NEAR(samples[1].mean(), all, five * samples[1].mean_error() + 1e-3);
  EXPECT_NEAR(samples[0].mean(), 0.25 / all, five * samples[0].mean_error() + 1e-3);
}

TEST(VirtualLightsMutants, TheUnhiddenTargetIsTheOriginalInAConvexRoom) {
  const auto broken = prepare("mutants/target_unhidden", in(ceiling));
  const auto sound = prepare("virtual_lights/weighted", in(ceiling));
  EXPECT_EQ(observe(broken, 200, 16)[0].values, observe(sound, 200, 16)[0].values);
}

// M times the bias tends to I Var g - Cov(f, g). Without the jackknife's share it tends to - Cov(f,
// g), with other points to I Var g. False-alarm rate 1e-6 each.
TEST(Ratio, MutantsHaveTheBiasOfTheirDefect) {
  struct Case {
    const char* plugin;
    double bias;
    double rest;  // of terms 1 / M^2 and higher
  };
  const double integral = tabulated("ratio_integral");
  const double variance = tabulated("ratio_variance");
  const double covariance = tabulated("ratio_covariance");
  const double plain = (variance - covariance) / 16;
  for (const auto& [name, bias, rest] :
       {Case{"analytic/ratio", plain, 0.002},
        {"analytic/jackknifed_ratio", 0, 0.004},
        {"mutants/ratio_of_other_points", variance / 16, 0.03},
        {"mutants/mean_of_ratios", tabulated("mean_of_ratios") - integral, 0},
        {"mutants/jackknifed_numerator", plain, 0.002},
        {"mutants/jackknifed_denominator", -covariance / 16, 0.03}}) {
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
