// The mutants of the luminaire family miss the reference by what is known of them.

#include <gtest/gtest.h>

#include <ostream>

#include "tests/estimators/sampling.h"

namespace assay {
namespace {

constexpr std::uint64_t observations = 1u << 20;

struct Bias {
  const char* mutant;
  std::string scene;
  double relative;   ///< expected
  double precision;  ///< half a digit of what is expected
};

void PrintTo(const Bias& bias, std::ostream* out) { *out << bias.mutant; }

class LuminaireMutants : public testing::TestWithParam<Bias> {};

// Within the digits given plus 3.89 standard errors (false-alarm rate below 1e-4 each).
TEST_P(LuminaireMutants, AreBiasedAsExpected) {
  const auto& [mutant, scene, expected, precision] = GetParam();
  const auto setup = tests::prepared(mutant, scene);
  const std::string original = find_plugin(mutant, {}).information.original;
  const tests::Summary s = tests::summary(*setup, original, observations);
  const double mean = *setup->channels()[0].mean;
  EXPECT_LT(std::abs(s.mean / mean - 1 - expected),
            precision + tests::z_limit * s.mean_error() / mean);
}

const std::string triangle = "triangle";

INSTANTIATE_TEST_SUITE_P(
    Table, LuminaireMutants,
    testing::Values(
        // no_cosine gives the solid angle: 0.5476313920 / 0.4810469073.
        Bias{"mutants/no_cosine", triangle, 0.5476313920 / 0.4810469073 - 1, 1e-9},
        Bias{"mutants/nonuniform_triangle", triangle, -0.254, 5e-4},
        Bias{"mutants/no_change_of_variables", triangle, 1.34, 5e-3},
        Bias{"mutants/inverse_distance", triangle, 0.289, 5e-4},
        Bias{"mutants/no_light_cosine", triangle, 0.319, 5e-4},
        Bias{"mutants/half_dropped", triangle, -0.5, 0},
        Bias{"mutants/one_percent", triangle, 0.01, 0},
        Bias{"mutants/arvo_uniform_arc", triangle, 0.0032, 5e-5},
        Bias{"mutants/arvo_uniform_angle", triangle, -0.047, 5e-4},
        Bias{"mutants/solid_angle_density", triangle, -0.040, 5e-4},
        Bias{"mutants/reversed_difference", triangle, -2, 0},
        // Without the clamp the part below the horizon counts with its distance from Lambert's
        // unclipped formula, which subtracts it: 2 x 0.5091770 - 0.44965.
        Bias{"mutants/absolute_cosine", tests::horizon_scene, (0.5091770 - 0.44965) / 0.5091770,
             2e-5},
        Bias{"mutants/unclipped_reference", tests::horizon_scene, 0.5091770 / 0.44965 - 1, 2e-5}));

TEST(LuminaireMutants, TwoSidedLightShinesBackwards) {
  const std::string away =
      "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[.2, -.4, 1], [1.6, "
      ".3, 1.4], [-.3, 1.2, 1.1]], normal: [-.57, -.34, 2.59], radiance: 1}}";
  const auto setup = tests::prepared("mutants/two_sided_light", away);
  EXPECT_EQ(setup->channels()[0].mean, 0);
  // False-alarm rate 1e-4.
  const tests::Summary s = tests::summary(*setup, "luminaire/area", observations);
  EXPECT_LT(std::abs(s.mean - 0.481046907316) / s.mean_error(), tests::z_limit);
}

// Same stream, same numbers: the harness calls such a mutant never activated.
TEST(LuminaireMutants, ThatAreNotActivatedGiveTheOriginalsNumbers) {
  for (const char* mutant :
       {"mutants/two_sided_light", "mutants/absolute_cosine", "mutants/unclipped_reference"}) {
    const auto original = tests::prepared("luminaire/area", "triangle")->make();
    const auto broken = tests::prepared(mutant, "triangle")->make();
    for (std::uint64_t i = 0; i < 100; ++i) {
      Stream one({1}, i);
      Stream two({1}, i);
      double a = 0;
      double b = 0;
      Cost cost;
      original->secondary(one, 4, {&a, 1}, cost);
      broken->secondary(two, 4, {&b, 1}, cost);
      EXPECT_EQ(a, b) << mutant;
    }
  }
}

TEST(LuminaireMutants, StateTheirOriginalAndDefect) {
  int count = 0;
  for (const Entry& entry : catalogue()) {
    if (!entry.information.original.starts_with("luminaire/")) continue;
    ++count;
    EXPECT_FALSE(entry.information.defect.empty());
    EXPECT_FALSE(entry.prepare == nullptr);
  }
  EXPECT_EQ(count, 19);
}

}  // namespace
}  // namespace assay
