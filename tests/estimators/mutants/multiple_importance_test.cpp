// The mutants of multiple importance sampling tend to what quadrature from elsewhere says.

#include <gtest/gtest.h>

#include "tests/estimators/direct_light/scenes.h"
#include "tests/estimators/draws.h"
#include "tests/estimators/table.h"

namespace assay {
namespace {

using namespace assay::draws;
using direct_light_scenes::parameters;

std::string more(const std::string& mutant) {
  if (mutant == "brdf_weight_without_counts" || mutant == "weights_without_counts") {
    return "brdf_samples: 3";
  }
  return mutant == "misses_not_counted" ? "brdf_samples: 4" : "";
}

// False-alarm rate 1e-6 each; the table is good to 1e-6.
TEST(MultipleImportanceMutants, AreBiasedAsExpected) {
  for (const auto& row : tests::table("direct_light_mutants.csv")) {
    const auto mutant = prepare("mutants/" + row[0], parameters("small", "glossy", more(row[0])));
    const double mean = *mutant.setup->channels()[0].mean;
    const Sample sample = observe(mutant, 200000)[0];
    EXPECT_NEAR(sample.mean() / mean - 1, std::stod(row[1]),
                five * sample.mean_error() / mean + 2e-6)
        << row[0];
  }
}

// The claimed range and variance are the originals' alone.
TEST(MultipleImportanceMutants, ClaimTheOriginalsMeanAndNoMore) {
  const auto mutant = prepare("mutants/weights_squared", parameters("small", "glossy"));
  const auto original = prepare("direct_light/multi_sample", parameters("small", "glossy"));
  EXPECT_NEAR(*mutant.setup->channels()[0].mean, *original.setup->channels()[0].mean, 1e-9);
  EXPECT_FALSE(mutant.setup->channels()[0].variance.has_value());
  EXPECT_EQ(mutant.key, original.key);
}

TEST(MultipleImportanceMutants, WithEqualCountsLeavingThemOutChangesNothing) {
  const auto original = prepare("direct_light/multi_sample", parameters("small", "glossy"));
  for (const char* name : {"weights_without_counts", "brdf_weight_without_counts",
                           "misses_not_counted", "light_from_behind"}) {
    const auto mutant = prepare(std::string("mutants/") + name, parameters("small", "glossy"));
    EXPECT_EQ(observe(mutant, 300)[0].values, observe(original, 300)[0].values) << name;
  }
}

TEST(MultipleImportanceMutants, TheBackOfALightShines) {
  const std::string away = "{scene: {" + direct_light_scenes::receiver +
                           ", light: {polygon: " + direct_light_scenes::small +
                           ", normal: [0.7173561, 0, 0.6967067], radiance: 1}}" +
                           direct_light_scenes::brdf("glossy") + "}";
  const auto mutant = prepare("mutants/light_from_behind", away);
  EXPECT_EQ(mutant.setup->channels()[0].mean, 0);
  // The BRDF's samples see what the front would show.
  const Sample sample = observe(mutant, 20000)[0];
  EXPECT_NEAR(sample.mean(), .343091, five * sample.mean_error());
}

}  // namespace
}  // namespace assay
