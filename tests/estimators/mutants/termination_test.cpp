// The mutants of path termination miss the reference by what follows from their defect.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "tests/estimators/draws.h"

namespace assay {
namespace {

constexpr std::uint64_t observations = 1u << 14;

// A tenth and more of each channel is 0 for long: means of 16 primaries are near normal.
constexpr std::uint64_t primaries = 16;

struct Bias {
  const char* mutant;
  std::string parameters;
  double relative;  ///< expected
};

void PrintTo(const Bias& bias, std::ostream* out) { *out << bias.mutant; }

class TerminationMutants : public testing::TestWithParam<Bias> {};

// False-alarm rate 1e-6 each.
TEST_P(TerminationMutants, AreBiasedAsTheirDefectSays) {
  const auto& [mutant, parameters, expected] = GetParam();
  const draws::Prepared plugin = draws::prepare(mutant, parameters);
  const draws::Sample sample = draws::observe(plugin, observations, primaries)[0];
  const double mean = plugin.setup->channels()[0].mean.value();
  EXPECT_LT(std::abs(sample.mean() / mean - 1 - expected),
            draws::five * sample.mean_error() / mean);
}

// Three zones of fraction, albedo and emission (.4, .2, 0), (.45, .9, .1) and (.15, .05, 2); the
// camera sees the second.
const std::string zoned =
    "{scene: {zones: [{top: -.2, emission: 0, albedo: .2}, {top: .7, emission: .1, albedo: .9}, "
    "{top: 1, emission: 2, albedo: .05}], camera: {position: [0, 0, 0], direction: [1, 0, 0]}}}";

// L of the second zone where it and the zones (the mean of what they reflect of what arrives) keep
// so much.
constexpr double zoned_radiance(double seen, double mean) {
  return .1 + seen * (.45 * .1 + .15 * 2) / (1 - mean);
}
constexpr double sound = zoned_radiance(.9, .4 * .2 + .45 * .9 + .15 * .05);

INSTANTIATE_TEST_SUITE_P(
    Table, TerminationMutants,
    testing::Values(
        // Adds e = a L = 1 at the end of every path of L = 2.
        Bias{"mutants/terminal_not_subtracted", "{scene: furnace}", 0.5},
        // Sum of a^2k, 4/3, for that of a^k, 2.
        Bias{"mutants/throughput_not_divided", "{scene: furnace}", -1. / 3},
        Bias{"mutants/depth_limit", "{scene: furnace}", -std::pow(0.5, 9)},
        // The first vertex does not shine, so that eight of the later ones are left.
        Bias{"mutants/depth_limit", "{scene: sphere}", -std::pow(0.8, 8)},
        // e = .4; one hit in ten raises it by .4, which is lost a quarter each of 4 times: .04 of
        // .4.
        Bias{"mutants/terminal_from_hindsight", "{scene: sphere}", -0.1},
        Bias{"mutants/direct_light_twice", "{scene: sphere, direct: exact}", 0},
        // Nothing comes from the first and the third zone but emission.
        Bias{"mutants/dark_surfaces_end", zoned, zoned_radiance(.9, .45 * .9) / sound - 1},
        // With s = 1.08 one path in one goes on, and weighs a / 1.08.
        Bias{"mutants/survival_above_one", zoned,
             zoned_radiance(.9 / 1.08, .4 * .2 + .45 * .9 / 1.08 + .15 * .05) / sound - 1},
        // n = 3.6 at the first vertex: 3 children of a quarter each. Then n = .9 becomes 1.
        Bias{"mutants/at_least_one_child", zoned,
             zoned_radiance(.75, .4 * .2 + .45 + .15 * .05) / sound - 1},
        // 3.6 becomes 4, .9 becomes 1, .2 and .05 nothing.
        Bias{"mutants/rounded_number", zoned, zoned_radiance(1, .45) / sound - 1},
        // 2 children where n = 3.2.
        Bias{"mutants/capped_number", "{scene: sphere}", 2 / 3.2 - 1},
        Bias{"mutants/small_numbers_dropped", zoned,
             zoned_radiance(.9, .4 * .2 + .45 * .9) / sound - 1},
        // Red of the coloured sphere. A throughput that stays 1 makes the albedo the probability:
        // .8, .75, .85 and .6. The result is .8 x .1 / (1 - .78) for .8 x .1 / (1 - .375).
        Bias{"mutants/divided_by_itself", "{scene: coloured_sphere}", .625 / .22 - 1}));

struct Caught {
  const char* mutant;
  std::string parameters;
};

void PrintTo(const Caught& caught, std::ostream* out) { *out << caught.mutant; }

class CaughtMutants : public testing::TestWithParam<Caught> {};

// Each channel is off by more than a standard normal would be with probability 1e-6, and by a
// tenth.
TEST_P(CaughtMutants, MissEveryChannel) {
  const draws::Prepared plugin = draws::prepare(GetParam().mutant, GetParam().parameters);
  const auto samples = draws::observe(plugin, observations, primaries);
  const std::vector<Channel> channels = plugin.setup->channels();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].diagnostic) continue;
    const double off = std::abs(samples[c].mean() - channels[c].mean.value());
    EXPECT_GT(off, draws::five * samples[c].mean_error()) << channels[c].name;
    EXPECT_GT(off, 0.1 * *channels[c].mean) << channels[c].name;
  }
}

const std::string by_throughput = "{scene: coloured_sphere, rule: throughput}";

INSTANTIATE_TEST_SUITE_P(Table, CaughtMutants,
                         testing::Values(Caught{"mutants/clamped_survival", by_throughput},
                                         Caught{"mutants/luminance_throughput", by_throughput},
                                         Caught{"mutants/survival_after_update", by_throughput},
                                         Caught{"mutants/drawn_number", "{scene: sphere}"},
                                         Caught{"mutants/split_while_bright", "{scene: sphere}"},
                                         Caught{"mutants/number_from_first_child",
                                                "{scene: sphere}"}));

// Same stream, same numbers: such a mutant is never activated.
TEST(TerminationMutants, ThatAreNotActivatedGiveTheOriginalsNumbers) {
  for (const auto& [mutant, parameters] :
       {std::pair{"mutants/small_numbers_dropped", "{scene: sphere}"},
        {"mutants/dark_paths_killed", "{scene: sphere}"},
        {"mutants/dark_surfaces_end", "{scene: sphere}"},
        {"mutants/clamped_survival", "{scene: sphere}"},
        {"mutants/survival_after_update", "{scene: sphere}"},
        {"mutants/capped_number", "{scene: sphere, splitting: 2}"}}) {
    const draws::Prepared broken = draws::prepare(mutant, parameters);
    const draws::Prepared original = draws::prepare(broken.information.original, parameters);
    ASSERT_EQ(broken.key, original.key);
    EXPECT_EQ(draws::observe(broken, 1000)[0].values, draws::observe(original, 1000)[0].values)
        << mutant;
  }
}

std::string refusal(const char* mutant, const std::string& parameters) {
  try {
    draws::prepare(mutant, parameters);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(TerminationMutants, ThatWouldNeverEndAreRefused) {
  EXPECT_THAT(refusal("mutants/survival_above_one", "{scene: sphere}"),
              testing::HasSubstr("its paths never end"));
  for (const char* mutant : {"mutants/at_least_one_child", "mutants/rounded_number"}) {
    EXPECT_THAT(refusal(mutant, "{scene: sphere}"), testing::HasSubstr("its trees never end"));
  }
}

}  // namespace
}  // namespace assay
