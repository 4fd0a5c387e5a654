#include <gtest/gtest.h>

#include <string>

#include "tests/estimators/draws.h"

namespace assay {
namespace {

using namespace assay::draws;

struct Bias {
  const char* mutant;
  std::string parameters;
  std::size_t channel;
  double low;  // bounds of the relative bias
  double high;
};

// What each says of its bias, within a fourth of it; the standard errors are below a tenth of that.
TEST(MetropolisMutants, AreBiasedAsTheySay) {
  const std::string rare_branches = "{target: branches, pixels: 2, p_large: .02}";
  const std::string border = "{target: boundary, pixels: 64, p_large: .1}";
  const std::vector<Bias> table = {{"asymmetric", "{}", 2, -.36, -.22},
                                   {"inverted_ratio", "{}", 2, -.70, -.55},
                                   {"unbounded_ratio", "{}", 3, -.35, -.15},
                                   {"rejected_not_counted", "{}", 2, -.30, -.17},
                                   {"current_dropped", "{}", 2, -.55, -.37},
                                   {"current_pixel", "{target: coloured_peak}", 2, .95, 1.5},
                                   {"current_pixel_multiple", "{}", 0, -.36, -.22},
                                   {"large_omitted", "{}", 0, -.85, -.55},
                                   {"large_always", "{}", 2, .30, .60},
                                   {"normaliser_scaled", "{}", 5, .005, .09},
                                   {"first_restored", "{}", 2, -.24, -.12},
                                   {"large_not_saved", "{}", 0, .50, .95},
                                   {"large_time_on_rejection", "{}", 0, .22, .42},
                                   {"not_freshened", rare_branches, 0, -.7, -.4},
                                   {"clamped", border, 0, .08, .24}};
  for (const auto& [name, parameters, channel, low, high] : table) {
    const auto mutant = prepare(std::string("mutants/metropolis_") + name, parameters);
    const double exact = *mutant.setup->channels()[channel].mean;
    const double bias = observe(mutant, 2000, 500)[channel].mean() / exact - 1;
    EXPECT_GT(bias, low) << name;
    EXPECT_LT(bias, high) << name;
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
      EXPECT_NEAR(samples[p].mean(), *mutant.setup->channels()[p].mean,
                  five * samples[p].mean_error())
          << name << p;
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
  const double exact = *mutant.setup->channels()[2].mean;
  EXPECT_LT(bright.mean(), exact - five * bright.mean_error());
}

}  // namespace
}  // namespace assay
