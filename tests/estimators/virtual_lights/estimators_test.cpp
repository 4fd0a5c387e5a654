#include "tests/estimators/prelude.h"
// Virtual lights and their mutants against closed forms and quadrature.

namespace assay {
namespace {

const std::array<const char*, 6> walls = {
    "[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]", "[[0,0,1],[0,1,1],[1,1,1],[1,0,1]]",
    "[[0,1,0],[1,1,0],[1,1,1],[0,1,1]]", "[[0,0,0],[0,1,0],[0,1,1],[0,0,1]]",
    "[[1,0,0],[1,0,1],[1,1,1],[1,1,0]]", "[[0,0,0],[0,0,1],[1,0,1],[1,0,0]]"};

struct Cube {
  bool even = true;  ///< all walls emit, or the ceiling alone
  std::string camera = "0.5, 0.5";
  std::string albedo = "0.5";
};

// A cube of albedo 0.5, its floor seen from straight above, and more parameters.
std::string in(const Cube& cube, const std::string& more = "") {
  std::string text =
      "{scene: {camera: {position: [" + cube.camera + ", 0.5], direction: [0, 0, -1]}, surfaces: [";
  for (std::size_t i = 0; i < walls.size(); ++i) {
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

Prepared weighted(const Cube& cube, const std::string& more = "") {
  return prepare("virtual_lights/weighted", in(cube, more));
}

// A corridor with a corner.
std::string corridor(const std::string& surface) {
  return "{scene: {camera: {position: [1.6, .5, .5], direction: [0, 0, -1]}, furnace: {obj: "
         "room.obj, " +
         surface + "}}, weighting: marginal}";
}

// False-alarm rate 1e-6 each. A lobe of the same albedo in a room of even light reflects what a
// diffuse surface does.
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
        {"virtual_lights/classic", in({.albedo = "0.3"}), 0.09},
        {"virtual_lights/classic", in(even, ", shininess: 3"), .25},
        {"virtual_lights/classic", in(even, ", shininess: 60"), .25},
        {"virtual_lights/gather", in(even, ", shininess: 3"), .25},
        {"virtual_lights/gather", in(even, ", shininess: 60"), .25}}) {
    const Prepared lights = prepare(name, parameters);
    EXPECT_NEAR(lights.channel().mean.value_or(mean), mean, 1e-9) << name << parameters;
    EXPECT_THAT(observe(lights, 20000, 16)[0], HasMean(mean, 1e-4 * mean)) << name << parameters;
  }
}

TEST(VirtualLights, TheTargetsIntegralIsThatOfWhatCanBeShotAt) {
  const auto integral = [](const Cube& cube, const char* weighting) {
    return *weighted(cube, std::string(", weighting: ") + weighting).channel(1).mean;
  };
  // The receiver is moved by 2^-14 of the way to the middle of its triangle.
  EXPECT_NEAR(integral(even, "conditional"), 5. / 6, 1e-4);
  EXPECT_DOUBLE_EQ(integral(even, "marginal"), 1);
  EXPECT_NEAR(integral(ceiling, "conditional"), 1 - form_factor_of_ceiling, 1e-4);
  EXPECT_NEAR(integral(ceiling, "marginal"), 1 - form_factor_of_ceiling, 1e-4);
}

// False-alarm rate 1e-6 each: the mean of g / p is G, the estimate near the answer.
TEST(VirtualLights, WeightedOnesAreConsistent) {
  const auto samples = observe(weighted(ceiling, ", weighting: marginal"), 500, 2048);
  EXPECT_THAT(samples[1], HasMean(1 - form_factor_of_ceiling, 1e-4));
  EXPECT_THAT(samples[0], HasMean(from_ceiling, 1e-3 * from_ceiling));
}

// In the middle and in the corner, in colours, in a furnace of any shape, and by a lobe. It sees
// nothing of a light on the floor, which has a sixth of the area; that it has half of 50 lights is
// rarer than 1e-7.
TEST(VirtualLights, ByTheMarginalDensityEvenEmissionGivesAConstant) {
  const std::string marginal = ", weighting: marginal";
  const Prepared colours = weighted({.albedo = "[0.2, 0.4, 0.6]"}, marginal);
  const Prepared room = prepare("virtual_lights/weighted", corridor("emission: 2, albedo: .6"));
  const Prepared lobe = weighted(even, ", shininess: 60" + marginal);
  for (const Prepared& lights : {weighted(even, marginal), colours, room, lobe,
                                 weighted({.camera = "0.005, 0.005"}, marginal)}) {
    const auto samples = observe(lights, 50, 16);
    for (std::size_t c = 0; c + 1 < samples.size(); ++c) {
      const double mean = *lights.channel(c).mean;
      const bool may_be_dark = lights.key == lobe.key;
      EXPECT_THAT(samples[c].values, Each(AnyOf(may_be_dark ? 0 : mean, DoubleNear(mean, 1e-12))));
      EXPECT_GT(samples[c].mean(), mean / 2);
    }
  }
  EXPECT_DOUBLE_EQ(*weighted(even, marginal).channel().mean, .25);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(*colours.channel(c).mean, std::pow(0.2 * static_cast<double>(c + 1), 2), 1e-15);
  }
  EXPECT_DOUBLE_EQ(*room.channel().mean, 2 * 0.36);
  EXPECT_EQ(*room.channel(1).mean, 1);
}

/// Observations of two plugins, one by one: the first are the second's times a factor.
void expect_scaled(const Prepared& scaled, const Prepared& plain, double factor) {
  const auto a = values_by(plain.key, scaled, 50, 16);
  const auto b = values_by(plain.key, plain, 50, 16);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(a[i], factor * b[i], 1e-12);
}

TEST(VirtualLights, AGivenIntegralScalesTheEstimate) {
  expect_scaled(weighted(ceiling, ", target_integral: 1"),
                weighted(ceiling, ", target_integral: 0.5"), 2);
}

// 1 / G - 1 whatever M; the number of lights; nothing, since from the middle of the floor all other
// walls are half a side away and more; nothing, since a convex room hides nothing.
TEST(VirtualLightsMutants, AreTheOriginalTimesAFactor) {
  struct Case {
    const char* mutant;
    std::string parameters;
    double factor;
  };
  const auto over_target = [](const Cube& cube) { return 1 / *weighted(cube).channel(1).mean; };
  for (const auto& [name, parameters, factor] :
       {Case{"mutants/target_integral_one", in(even), over_target(even)},
        {"mutants/target_integral_one", in(ceiling), over_target(ceiling)},
        {"mutants/power_not_divided", in(ceiling), 16},
        {"mutants/clamped_distance", in(even, ", least_distance: 0.49"), 1},
        {"mutants/target_unhidden", in(ceiling), 1}}) {
    SCOPED_TRACE(name);
    const Prepared mutant = prepare(name, parameters);
    const bool clamps = name == std::string("mutants/clamped_distance");
    const Prepared sound = prepare(mutant.information.original, clamps ? in(even) : parameters);
    EXPECT_EQ(mutant.key, sound.key);
    expect_scaled(mutant, sound, factor);
  }
}

// A form factor with no distance below `least_distance`. The corner's receiver is moved by 0.4 % of
// its distance to the walls, which changes the near light by as much. False-alarm rate 1e-6 each.
TEST(VirtualLightsMutants, AClampedDistanceLosesTheLightOfTheCorner) {
  for (const std::string least : {"0.1", "0.3"}) {
    const double kept = tabulated("clamped_" + least + "_in_corner");
    const auto mutant = prepare("mutants/clamped_distance",
                                in({.camera = "0.005, 0.005"}, ", least_distance: " + least));
    EXPECT_THAT(observe(mutant, 4000, 64)[0], HasMean(0.25 * kept, 0.001 * kept)) << least;
  }
}

// By E[S] E[1/S] of independent sums of g / p, f being in proportion to g. False-alarm rate 1e-6.
TEST(VirtualLightsMutants, TheTargetOfOtherPathsLeavesTheMeanOfAQuotient) {
  const auto plugin = prepare("mutants/target_of_other_paths", in(even, ", weighting: marginal"));
  for (const unsigned count : {8U, 16U}) {
    const double bias = tabulated("other_paths_" + std::to_string(count));
    EXPECT_THAT(observe(plugin, 20000, count)[0], HasMean(.25 * (1 + bias), .25e-3)) << count;
  }
}

// The terms in place of g / p have this mean, so that the estimate tends to 0.25 x 5/6 of its
// inverse. Its variance is infinite, by a logarithm, but the mean of a million values is normal.
// False-alarm rate 1e-6 each.
TEST(VirtualLightsMutants, ADensityOfDirectionsTendsToSomethingElse) {
  const auto samples = observe(prepare("mutants/density_of_direction", in(even)), 500, 2048);
  const double target = tabulated("density_of_direction_target");
  EXPECT_THAT(samples[1], HasMean(target, 1e-3));
  const double limit = 0.25 * 5 / 6 / target;
  EXPECT_THAT(samples[0], HasMean(limit, 1e-2 * limit));
}

// The density of the virtual light in units of power, a^2 A F, is f / g. The limit is its mean
// among lights that are seen. Consistent to 1 / M of the chance that none is. False-alarm rate
// 1e-6.
TEST(VirtualLightsMutants, TheMeanOfRatiosIsThatOfTheDensity) {
  const auto plugin = prepare("mutants/mean_of_weights", in(ceiling, ", weighting: marginal"));
  const double mean = tabulated("mean_of_weights");
  EXPECT_THAT(observe(plugin, 4000, 64)[0], HasMean(mean, 1e-3 * mean));
}

// Since f / g is constant, the limit is the answer over a sum of form factors. It is over all faces
// that are turned to the receiver, hidden or not. M = 1024 is off by 1 / M. False-alarm rate 1e-6.
TEST(VirtualLightsMutants, AnUnhiddenTargetDividesByWhatIsHiddenToo) {
  const auto samples =
      observe(prepare("mutants/target_unhidden", corridor("emission: 1, albedo: .5")), 1000, 1024);
  const double all = tabulated("unhidden_in_corridor");
  EXPECT_THAT(samples[1], HasMean(all, 1e-3));
  EXPECT_THAT(samples[0], HasMean(0.25 / all, 1e-3));
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
    EXPECT_THAT(observe(prepare(name), 200000, 16)[0], HasMean(integral + bias, rest)) << name;
  }
}

TEST(Ratio, OnePointLeavesNothingToLeaveOut) {
  const auto plain = prepare("analytic/ratio");
  EXPECT_EQ(values_by(plain.key, prepare("analytic/jackknifed_ratio"), 20),
            values_by(plain.key, plain, 20));
}

}  // namespace
}  // namespace assay
