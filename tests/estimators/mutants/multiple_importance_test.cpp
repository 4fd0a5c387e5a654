// The mutants of multiple importance sampling tend to what quadrature from elsewhere says.

#include "tests/estimators/draws.h"
#include "tests/estimators/scenes.h"
#include "tests/estimators/table.h"
#include "tests/prelude.h"

namespace assay {
namespace {

using namespace assay::draws;
using direct_light_scenes::parameters;

// The claimed range and variance are the originals' alone.
TEST(MultipleImportanceMutants, ClaimTheOriginalsMeanAndNoMore) {
  const auto mutant = prepare("mutants/weights_squared", parameters("small", "glossy"));
  const auto original = prepare("direct_light/multi_sample", parameters("small", "glossy"));
  EXPECT_NEAR(*mutant.setup->channels()[0].mean, *original.setup->channels()[0].mean, 1e-9);
  EXPECT_FALSE(mutant.setup->channels()[0].variance.has_value());
  EXPECT_EQ(mutant.key, original.key);
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
