// Every family is held against the means, variances and ranges that it declares, and its mutants
// against the bias of their defect. False alarms: 1e-6 for each comparison.

#include "tests/estimators/draws.h"
#include "tests/estimators/scenes.h"
#include "tests/estimators/table.h"
#include "tests/prelude.h"

namespace assay {
namespace {

using namespace assay::draws;
using Texts = std::vector<std::string>;

const std::string data = ASSAY_SOURCE_DIR "/suites/data";

/// Plugins of a name's beginning, with all their parameters.
struct Family {
  const char* name;
  Texts plugins;
  Texts parameters;
  std::uint64_t count = 100000;
  std::uint64_t primaries = 1;
};
void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

const std::string zones =
    "zones: [{top: -.2, emission: 0, albedo: .2}, {top: .7, emission: .1, albedo: .9}, {top: 1, "
    "emission: 2, albedo: .5}], camera: {position: [.1, 0, 0], direction: [0, 0, -1]}";
const std::string lens_corner =
    "{scene: {lens: {radius: .2, focus: 2}, background: .3, planes: [{depth: 1, x: [0, 100], y: "
    "[-100, .02], radiance: 0}, {depth: 3, x: [-.1, .05], y: [-.1, 100], radiance: .5, amplitude: "
    ".5, wavelength: .1, phase: .4}]}, pixel: [.04, .01]}";
const std::string smooth_sky = "{harmonics: [3, .4, -.3, .5, .2, -.35, .3, .25, -.2]}";
const std::string peaked_sky =
    "{peak: {base: .2, height: 20, sharpness: 60, direction: [.3, .2, .8]}}";

/// Parameters of a law, whose text has commas that a flow map does not take.
Value law(const std::string& law, const char* shift = "0", const char* scale = "1") {
  return Value::map({{"law", Value::scalar(law)},
                     {"shift", Value::scalar(shift)},
                     {"scale", Value::scalar(scale)}});
}

/// The built-in rectangle hidden beyond t, and more parameters.
std::string hidden(double t, const std::string& more) {
  return "{scene: " + hidden_beyond(t) + ", " + more + "}";
}

Texts lambdas(double t) {
  return {hidden(t, "lambda: 0"), hidden(t, "lambda: 1"), hidden(t, "lambda: -0.7")};
}

Texts of_surface(const Texts& more) {
  Texts all;
  for (const std::string& each : more) {
    all.push_back(direct_light_scenes::parameters("small", "glossy", each));
  }
  return all;
}

Texts maps(const Texts& more) {
  Texts all;
  for (const std::string& each : more) all.push_back("{map: sky.exr, normal: " + each + "}");
  return all;
}

Texts skies(const Texts& more) {
  Texts all;
  for (const std::string& each : more) all.push_back("{sky: " + each + "}");
  return all;
}

Texts scenes(const Texts& names) {
  Texts all;
  for (const std::string& name : names) all.push_back(scene(name));
  return all;
}

Texts targets(const Texts& more) {
  Texts all;
  for (const char* target : {"constant", "peak", "coloured_peak", "boundary", "mixture", "branches",
                             "sphere", "coloured_sphere"}) {
    for (const std::string& each : more) all.push_back(std::string("{target: ") + target + each);
  }
  return all;
}

const std::vector<Family> families{
    {"analytic/",
     {"dart_throwing", "exponential_uniform", "exponential_importance", "control_variate",
      "stratified", "antithetic", "normal", "two_level"},
     {"{}"},
     200000},
    {"analytic/", {"exponential_uniform"}, {"{}"}, 200000, 7},
    {"analytic/", {"control_variate"}, {"{coefficient: -1}"}, 200000},
    {"analytic/", {"stratified"}, {"{strata: 3}"}, 200000, 2},
    {"analytic/", {"heavy_tail"}, {"{index: 12}"}, 200000},
    {"analytic/",
     {"rare_spike"},
     {"{probability: 0.01, height: 3}", "{probability: 0.1, height: 3, noise: 0.5}"},
     200000},
    {"analytic/", {"normal"}, {"{mean: -3, deviation: 0.5}"}, 200000, 5},
    {"analytic/", {"costly_law"}, {"{law: exponential(2)}"}, 200000, 3},
    {"analytic/", {"two_level"}, {"{splitting: 0.4}", "{splitting: 2.5}"}, 200000},
    {"brdf/",
     {"ward", "ashikhmin_shirley"},
     {"{sampler: published}", "{sampler: density_rejection}", "{sampler: brdf_rejection}",
      "{sampler: brdf_cosine_rejection}"}},
    {"correlated/", {"area"}, lambdas(.5), 200000},
    {"correlated/", {"area"}, lambdas(.05), 200000},
    {"correlated/", {"area"}, lambdas(-.5), 200000},
    {"correlated/",
     {"sky"},
     skies({"{map: sky.exr}, sampling: uniform, lambda: 0",
            "{map: sky.exr}, sampling: uniform, lambda: 1",
            "{map: sky.exr}, sampling: cosine, lambda: 0",
            "{map: sky.exr}, sampling: cosine, lambda: 1",
            "{map: sky.exr}, sampling: emittance, lambda: 0",
            "{map: sky.exr}, sampling: emittance, lambda: 1",
            "{map: sky.exr}, sampling: steered, lambda: 0",
            "{map: sky.exr}, sampling: steered, lambda: 1"}),
     50000},
    {"depth_of_field/",
     {"pixel"},
     {"{scene: edge, pixel: [.04, .01]}", "{scene: sinusoid, pixel: [.04, .01]}", lens_corner,
      "{pixel: [.14, 0], jitter: 3}"}},
    {"depth_of_field/", {"two_stage"}, {"{pixel: [.14, 0]}"}, 60000},
    {"depth_of_field/",
     {"mirror"},
     {"{}", "{roughness: .01, pixel: .03}", "{curvature: .1, phase: 1}",
      "{curvature: -.2, roughness: .005, pixel: -.02, distance: .7, beyond: 1.4}"},
     200000},
    {"depth_of_field/",
     {"image"},
     {"{scene: edge, width: 12, height: 1, size: 0.5, samples: 6}"},
     20000},
    {"direct_light/", {"light"}, of_surface({"", "light_sampling: area"})},
    {"direct_light/", {"brdf"}, of_surface({""})},
    {"direct_light/", {"one_sample"}, of_surface({"", "heuristic: power"})},
    {"direct_light/",
     {"multi_sample"},
     of_surface({"", "heuristic: power", "brdf_samples: 3", "heuristic: maximum",
                 "heuristic: {cutoff: 0.1}"})},
    {"environment/",
     {"cosine", "emittance"},
     maps({"[0, 0, 1]", "[.3, -.5, .8]", "[-1, 0.2, -2]"}),
     200000},
    {"luminaire/",
     {"hemisphere", "cosine", "area", "solid_angle"},
     scenes({"triangle", "cornell_triangle", "rectangle", horizon_scene, hidden_beyond(0.5),
             hidden_beyond(0.05), hidden_beyond(-0.5)}),
     1u << 20},
    {"luminaire/", {"floor"}, {"{width: 6, height: 4, size: 3}"}, 4000},
    {"metropolis/", {"independent"}, targets({"}"}), 2000, 200},
    {"metropolis/",
     {"mean_value"},
     targets({", boundary: wrap, bootstrap: 64}", ", boundary: reflect, bootstrap: 64}",
              ", boundary: reject, bootstrap: 64}"}),
     2000,
     100},
    {"paths/",
     {"plain"},
     {"{scene: furnace}", "{scene: sphere}", "{scene: coloured_sphere}",
      "{scene: {" + zones + "}, survival: .9}"},
     1u << 17},
    {"paths/", {"ray_free"}, {"{scene: sphere}", "{scene: coloured_sphere}"}, 1u << 17},
    {"paths/",
     {"roulette"},
     {"{scene: furnace}", "{scene: sphere}", "{scene: sphere, direct: exact}",
      "{scene: sphere, direct: sampled}", "{scene: {" + zones + "}, rule: radiance}",
      "{scene: coloured_sphere, rule: throughput}", "{scene: coloured_sphere, rule: radiance}",
      "{scene: coloured_sphere, rule: radiance, direct: exact}"},
     1u << 17},
    {"paths/",
     {"improved_roulette"},
     {"{scale: .5}", "{scale: 2}", "{terminal: local}", "{scene: sphere}",
      "{scene: {" + zones + "}}", "{scene: {" + zones + "}, direct: sampled}",
      "{scene: coloured_sphere, rule: radiance}"},
     1u << 17},
    {"paths/",
     {"winners"},
     {"{scene: furnace}", "{scene: sphere}", "{scene: {" + zones + "}, splitting: 2.5}",
      "{scene: sphere, direct: exact, splitting: 8}", "{scene: sphere, direct: sampled}",
      "{scene: coloured_sphere}"},
     1u << 17},
    {"sky/",
     {"uniform", "cosine"},
     skies({"{uniform: 2}, normal: [.3, -.5, .8]", smooth_sky + ", normal: [.3, -.5, .8]",
            peaked_sky + ", normal: [.3, -.5, .8]",
            "{gradient: {base: 1, slope: [.5, .2, .3]}}, normal: [.3, -.5, .8]",
            "{map: sky.exr}, normal: [.3, -.5, .8]"})},
    {"steerable/", {"triangle"}, {"{weights: [1, 2, 5]}"}, 200000},
    {"steerable/",
     {"sky"},
     skies({smooth_sky + ", normal: [.3, -.5, .8]", peaked_sky, peaked_sky + ", level: 1",
            peaked_sky + ", coefficients: 4, offset: .9", peaked_sky + ", strata: 4",
            "{uniform: 1}", "{map: sky.exr}, normal: [1, .5, .3]", "{map: sky.exr}, floor: .5"}),
     50000},
};

class Families : public testing::TestWithParam<Family> {};

TEST_P(Families, AreWhatTheyDeclare) {
  const Family& family = GetParam();
  for (const std::string& plugin : family.plugins) {
    for (const std::string& parameters : family.parameters) {
      SCOPED_TRACE(plugin + ' ' + parameters);
      expect_declared(prepare(family.name + plugin, parameters, data), family.count,
                      family.primaries);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, Families, testing::ValuesIn(families));

TEST(Families, OfLawsAreWhatTheyDeclare) {
  for (const Value& parameters :
       {law("bernoulli(0.01)"), law("exponential(2)", "3", "0.5"), law("lognormal(0.2, 0.5)"),
        law("normal(1, 2)", "0", "3"), law("student_t(9)"), law("uniform(-1, 3)", "1"),
        law("zero_inflated(0.1)", "-1", "2")}) {
    SCOPED_TRACE(parameters.canonical());
    expect_declared(prepare("analytic/law", parameters), 200000);
  }
}

/// A mutant's mean is that which it declares, times 1 + `bias`.
struct Biased {
  std::string mutant;
  std::string parameters;
  double bias;
  double precision = 0;  ///< of what is known of it
  std::uint64_t count = 200000;
  std::uint64_t primaries = 1;
};
void PrintTo(const Biased& biased, std::ostream* out) { *out << biased.mutant; }

class Mutants : public testing::TestWithParam<Biased> {};

TEST_P(Mutants, HaveTheBiasOfTheirDefect) {
  const Biased& of = GetParam();
  const Prepared mutant = prepare("mutants/" + of.mutant, of.parameters, data);
  const double declared = mutant.setup->channels()[0].mean.value();
  const Sample sample = observe(mutant, of.count, of.primaries)[0];
  EXPECT_NEAR(sample.mean() / declared - 1, of.bias,
              of.precision + five * sample.mean_error() / declared);
}

constexpr std::uint64_t million = 1u << 20;
const std::string triangle = scene("triangle");
INSTANTIATE_TEST_SUITE_P(
    Luminaire, Mutants,
    testing::Values(
        // no_cosine gives the solid angle: 0.5476313920 / 0.4810469073.
        Biased{"no_cosine", triangle, 0.5476313920 / 0.4810469073 - 1, 1e-9, million},
        Biased{"nonuniform_triangle", triangle, -0.254, 5e-4, million},
        Biased{"no_change_of_variables", triangle, 1.34, 5e-3, million},
        Biased{"inverse_distance", triangle, 0.289, 5e-4, million},
        Biased{"no_light_cosine", triangle, 0.319, 5e-4, million},
        Biased{"half_dropped", triangle, -0.5, 0, million},
        Biased{"one_percent", triangle, 0.01, 0, million},
        Biased{"arvo_uniform_arc", triangle, 0.0032, 5e-5, million},
        Biased{"arvo_uniform_angle", triangle, -0.047, 5e-4, million},
        Biased{"solid_angle_density", triangle, -0.040, 5e-4, million},
        Biased{"reversed_difference", triangle, -2, 0, million},
        // Without the clamp the part below the horizon counts with its distance from Lambert's
        // unclipped formula, which subtracts it: 2 x 0.5091770 - 0.44965.
        Biased{"absolute_cosine", scene(horizon_scene), (0.5091770 - 0.44965) / 0.5091770, 2e-5,
               million},
        Biased{"unclipped_reference", scene(horizon_scene), 0.5091770 / 0.44965 - 1, 2e-5,
               million}));

constexpr double ward_albedo = 0.564185341;
constexpr double ashikhmin_shirley_albedo = 0.373216904;
Biased brdf(const char* mutant, double albedo, double mean, double digits) {
  return {mutant, "{}", mean / albedo - 1, digits / albedo, 400000};
}
// A single quadrant and the like are known to three decimals from simulations of other code;
// redrawing divides by the mass above the horizon.
INSTANTIATE_TEST_SUITE_P(
    Brdf, Mutants,
    testing::Values(brdf("ward_single_quadrant", ward_albedo, 0.767, 5e-4),
                    brdf("ward_uniform_azimuth", ward_albedo, 0.605, 5e-4),
                    brdf("ward_redrawn", ward_albedo, ward_albedo / 0.980180621, 1e-8),
                    brdf("ashikhmin_shirley_single_quadrant", ashikhmin_shirley_albedo, 0.499,
                         5e-4),
                    brdf("ashikhmin_shirley_unmirrored", ashikhmin_shirley_albedo, 0.408, 5e-4),
                    brdf("ashikhmin_shirley_exponent", ashikhmin_shirley_albedo,
                         0.993 * ashikhmin_shirley_albedo, 4e-4),
                    brdf("ashikhmin_shirley_redrawn", ashikhmin_shirley_albedo,
                         ashikhmin_shirley_albedo / 0.916368748, 1e-8)));

/// `bias` is absolute, of an irradiance.
Biased control(const char* mutant, const std::string& parameters, double irradiance, double bias) {
  return {mutant, parameters, bias / irradiance, 5e-6 / irradiance, 100000};
}
constexpr double all_seen = 1.320523614;
constexpr double seen = .17087090832672724;
const std::string bright =
    "{scene: {receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[-.8, -.6, 1], "
    "[.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 2}}, lambda: .5}";
INSTANTIATE_TEST_SUITE_P(
    Control, Mutants,
    testing::Values(control("control_added_twice", scene(hidden_beyond(-.5)), seen, 2 * all_seen),
                    control("control_without_pi", scene(hidden_beyond(-.5)), seen,
                            all_seen*(1 / std::numbers::pi - 1)),
                    control("control_visible", hidden(-.5, "lambda: .5"), seen,
                            .5 * (all_seen - seen)),
                    control("control_elsewhere", scene(hidden_beyond(-.5)), seen, 0),
                    control("control_unclipped", "{scene: " + horizon_scene + ", lambda: .5}",
                            .5091770, .5 * (.44965 - .5091770)),
                    control("control_without_radiance", bright, 2 * all_seen, -.5 * all_seen)));

const std::string smooth = "{sky: " + smooth_sky + ", normal: [.3, -.5, .8]}";
INSTANTIATE_TEST_SUITE_P(
    Steerable, Mutants,
    testing::Values(Biased{"steerable_no_jacobian",
                           "{sky: " + smooth_sky + ", normal: [.3, -.5, .8], level: 2}", -.049,
                           .001},
                    Biased{"steerable_no_offset", smooth, -.032, .001},
                    Biased{"steerable_small_offset", smooth, -.0065, .001},
                    Biased{"steerable_analytic_normaliser", smooth, -.145, .001},
                    Biased{"steerable_redrawn", smooth, .087, .001},
                    Biased{"steerable_absolute_cosine", smooth, 1.22, .02},
                    Biased{"steerable_map_density", smooth, -.0044, .001},
                    Biased{"steerable_flipped", smooth, .0709, .001},
                    Biased{"steerable_transcribed", "{sky: " + peaked_sky + "}", .0026, .001}));

// A tenth and more of each channel is 0 for long: means of 16 primaries are near normal.
Biased termination(const char* mutant, const std::string& parameters, double bias) {
  return {mutant, parameters, bias, 0, 1u << 14, 16};
}
// Three zones of fraction, albedo and emission (.4, .2, 0), (.45, .9, .1) and (.15, .05, 2); the
// camera sees the second.
const std::string zoned =
    "{scene: {zones: [{top: -.2, emission: 0, albedo: .2}, {top: .7, emission: .1, albedo: .9}, "
    "{top: 1, emission: 2, albedo: .05}], camera: {position: [0, 0, 0], direction: [1, 0, 0]}}}";
// L of the second zone where it and the zones (the mean of what they reflect of what arrives) keep
// so much.
constexpr double zoned_radiance(double visible, double mean) {
  return .1 + visible * (.45 * .1 + .15 * 2) / (1 - mean);
}
constexpr double sound = zoned_radiance(.9, .4 * .2 + .45 * .9 + .15 * .05);
INSTANTIATE_TEST_SUITE_P(
    Termination, Mutants,
    testing::Values(
        // Adds e = a L = 1 at the end of every path of L = 2.
        termination("terminal_not_subtracted", scene("furnace"), 0.5),
        // Sum of a^2k, 4/3, for that of a^k, 2.
        termination("throughput_not_divided", scene("furnace"), -1. / 3),
        termination("depth_limit", scene("furnace"), -std::pow(0.5, 9)),
        // The first vertex does not shine, so that eight of the later ones are left.
        termination("depth_limit", scene("sphere"), -std::pow(0.8, 8)),
        // e = .4; one hit in ten raises it by .4, which is lost a quarter each of 4 times: .04 of
        // .4.
        termination("terminal_from_hindsight", scene("sphere"), -0.1),
        termination("direct_light_twice", "{scene: sphere, direct: exact}", 0),
        // Nothing comes from the first and the third zone but emission.
        termination("dark_surfaces_end", zoned, zoned_radiance(.9, .45 * .9) / sound - 1),
        // With s = 1.08 one path in one goes on, and weighs a / 1.08.
        termination("survival_above_one", zoned,
                    zoned_radiance(.9 / 1.08, .4 * .2 + .45 * .9 / 1.08 + .15 * .05) / sound - 1),
        // n = 3.6 at the first vertex: 3 children of a quarter each. Then n = .9 becomes 1.
        termination("at_least_one_child", zoned,
                    zoned_radiance(.75, .4 * .2 + .45 + .15 * .05) / sound - 1),
        // 3.6 becomes 4, .9 becomes 1, .2 and .05 nothing.
        termination("rounded_number", zoned, zoned_radiance(1, .45) / sound - 1),
        // 2 children where n = 3.2.
        termination("capped_number", scene("sphere"), 2 / 3.2 - 1),
        termination("small_numbers_dropped", zoned,
                    zoned_radiance(.9, .4 * .2 + .45 * .9) / sound - 1),
        // Red of the coloured sphere. A throughput that stays 1 makes the albedo the probability:
        // .8, .75, .85 and .6. The result is .8 x .1 / (1 - .78) for .8 x .1 / (1 - .375).
        termination("divided_by_itself", scene("coloured_sphere"), .625 / .22 - 1)));

// Quadrature from elsewhere, good to 1e-6.
std::vector<Biased> of_multiple_importance() {
  std::vector<Biased> all;
  for (const auto& row : table("direct_light_mutants.csv")) {
    const std::string& name = row[0];
    const bool without = name == "brdf_weight_without_counts" || name == "weights_without_counts";
    const char* more = without                        ? "brdf_samples: 3"
                       : name == "misses_not_counted" ? "brdf_samples: 4"
                                                      : "";
    all.push_back({name, of_surface({more})[0], std::stod(row[1]), 2e-6});
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(MultipleImportance, Mutants, testing::ValuesIn(of_multiple_importance()));

// Same stream, same numbers: the harness calls such a mutant never activated.
TEST(Mutants, ThatAreNotActivatedGiveTheOriginalsNumbers) {
  const std::string glossy = of_surface({""})[0];
  for (const auto& [name, parameters] : std::vector<std::pair<std::string, std::string>>{
           {"two_sided_light", triangle},
           {"absolute_cosine", triangle},
           {"unclipped_reference", triangle},
           {"weights_without_counts", glossy},
           {"brdf_weight_without_counts", glossy},
           {"misses_not_counted", glossy},
           {"light_from_behind", glossy},
           {"small_numbers_dropped", scene("sphere")},
           {"dark_paths_killed", scene("sphere")},
           {"dark_surfaces_end", scene("sphere")},
           {"clamped_survival", scene("sphere")},
           {"survival_after_update", scene("sphere")},
           {"capped_number", "{scene: sphere, splitting: 2}"}}) {
    const Prepared mutant = prepare("mutants/" + name, parameters);
    const Prepared original = prepare(mutant.information.original, parameters);
    ASSERT_EQ(mutant.key, original.key) << name;
    EXPECT_EQ(observe(mutant, 1000)[0].values, observe(original, 1000)[0].values) << name;
  }
}

}  // namespace
}  // namespace assay
