
#include "tests/estimators/draws.h"
#include "tests/estimators/table.h"
#include "tests/prelude.h"
#include "tests/stats/calibration.h"

namespace assay {
namespace {

using namespace assay::draws;

// By the program's own sound chain on the same stream, to rounding: all that is recorded is in
// proportion to b.
TEST(MetropolisMutants, AScaledNormaliserScalesEveryObservation) {
  for (const char* scene : {"{bootstrap: 64}", "{target: coloured_peak, p_large: .2}"}) {
    const auto mutant = prepare("mutants/metropolis_normaliser_scaled", scene);
    const auto sound = prepare("metropolis/mean_value", scene);
    ASSERT_EQ(mutant.key, sound.key);
    const auto scaled = observe(mutant, 50, 100);
    const auto plain = observe(sound, 50, 100);
    for (std::size_t c = 0; c + 1 < plain.size(); ++c) {  // all but the acceptance
      for (std::size_t i = 0; i < 50; ++i) {
        EXPECT_NEAR(scaled[c].values[i], 1.05 * plain[c].values[i], 1e-12 * plain[c].values[i]);
      }
    }
    EXPECT_EQ(scaled.back().values, plain.back().values);
  }
}

// Nothing but the sums differs, and at p_large = 1 every step is a large one.
TEST(MetropolisMutants, TakingAllStepsForLargeIsRightWhereAllAre) {
  const char* all = "{p_large: 1, bootstrap: 64}";
  EXPECT_EQ(observe(prepare("mutants/metropolis_large_always", all), 20, 100)[2].values,
            observe(prepare("metropolis/multiple_importance", all), 20, 100)[2].values);
  // Without [large] the weights are those of plain points times a / (1 + I / (b p)) and the rest.
  EXPECT_NE(observe(prepare("mutants/metropolis_large_omitted", all), 20, 100)[2].values,
            observe(prepare("metropolis/multiple_importance", all), 20, 100)[2].values);
}

// An observation takes every element from the accepted state. So the sound one's missing part is
// that of the current states.
TEST(MetropolisMutants, WhatIsDroppedIsThePartOfTheCurrentState) {
  const auto dropped = observe(prepare("mutants/metropolis_current_dropped"), 50, 100);
  const auto sound = observe(prepare("metropolis/mean_value"), 50, 100);
  for (std::size_t i = 0; i < 50; ++i) {
    // The accepted part of the image's mean b is left: the sum of a b / I(y) x I(y).
    EXPECT_NEAR(dropped[8].values[i], sound[9].values[i] * sound[10].values[i], 1e-12);
    for (std::size_t p = 0; p < 8; ++p) EXPECT_LE(dropped[p].values[i], sound[p].values[i]);
  }
}

// The limits of the others have no closed form. They are held against a second program, which
// simulates the same chains by other code and another generator. False alarm 1e-6 for each of some
// 200 means, standard errors of both taken together.
TEST(MetropolisMutants, HaveTheImagesOfASecondProgram) {
  std::map<std::vector<std::string>, std::vector<std::pair<double, double>>> table;
  for (const auto& row : tests::table("metropolis_mutants.csv")) {
    table[{row.begin(), row.begin() + 4}].emplace_back(std::stod(row[5]), std::stod(row[6]));
  }
  EXPECT_EQ(table.size(), 20u);
  for (const auto& [scene, image] : table) {
    std::string name = "mutants/metropolis_" + scene[0];
    if (scene[0] == "sound") name = "metropolis/mean_value";
    if (scene[0] == "sound_multiple") name = "metropolis/multiple_importance";
    const auto samples = observe(prepare(name, "{target: " + scene[1] + ", pixels: " + scene[2] +
                                                   ", p_large: " + scene[3] + ", bootstrap: 64}"),
                                 tests::repetitions(10000), 200);
    for (std::size_t i = 0; i < image.size(); ++i) {
      const auto& [mean, error] = image[i];
      EXPECT_NEAR(samples[i].mean(), mean, five * std::hypot(samples[i].mean_error(), error))
          << name << " " << scene[1] << " " << i;
    }
  }
}

// Each mutant that is not unbiased differs from the exact image by more than chance in some
// element. Missed steps are too small a matter for the table's 16000 chains; the suite finds them
// with more.
TEST(MetropolisMutants, AreBiasedInTheSecondProgramToo) {
  std::map<std::vector<std::string>, bool> differs;
  for (const auto& row : tests::table("metropolis_mutants.csv")) {
    const auto sound =
        prepare("metropolis/mean_value", "{target: " + row[1] + ", pixels: " + row[2] + "}");
    const double exact = *sound.channel(std::stoul(row[4])).mean;
    differs[{row[0], row[1]}] |= std::abs(std::stod(row[5]) - exact) > five * std::stod(row[6]);
  }
  for (const auto& [key, found] : differs) {
    EXPECT_EQ(found, key[0] != "sound" && key[0] != "no_catching_up") << key[0] << " " << key[1];
  }
}

// They differ from their original in every scene, yet their means are the same: false alarm 1e-6
// each.
TEST(MetropolisMutants, SurviveWhereTheirDefectBalances) {
  for (const char* name : {"clamped", "current_pixel"}) {
    const auto mutant = prepare(std::string("mutants/metropolis_") + name);
    const auto sound = prepare("metropolis/mean_value");
    ASSERT_EQ(mutant.key, sound.key);
    const auto samples = observe(mutant, 2000, 500);
    EXPECT_NE(samples[2].values, observe(sound, 2000, 500)[2].values) << name;
    for (std::size_t p = 0; p < 8; ++p) {
      EXPECT_THAT(samples[p], HasMean(*mutant.channel(p).mean)) << name << p;
    }
  }
}

// The mean over the image is b, whatever the chain does. To rounding.
TEST(MetropolisMutants, OfChainsLeaveTheMeanOfTheImageAlone) {
  for (const char* name : {"asymmetric", "inverted_ratio", "rejected_not_counted", "first_restored",
                           "large_not_saved", "large_time_on_rejection", "clamped"}) {
    const auto samples = observe(prepare(std::string("mutants/metropolis_") + name), 20, 200);
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_NEAR(samples[8].values[i] / samples[9].values[i], 1, 1e-12) << name;
    }
  }
}

// False alarm 1e-6.
TEST(MetropolisMutants, ANormaliserFromOtherPointsThanTheStartIsBiased) {
  const auto mutant = prepare("mutants/metropolis_other_normaliser", "{bootstrap: 16}");
  const Sample bright = observe(mutant, 8000, 100)[2];
  const double exact = *mutant.channel(2).mean;
  EXPECT_LT(bright.mean(), exact - five * bright.mean_error());
}

}  // namespace
}  // namespace assay
