// Mutants of the luminaire family; families_test.cpp has their bias.

#include "tests/estimators/draws.h"
#include "tests/prelude.h"

namespace assay {
namespace {

// False-alarm rate 1e-6.
TEST(LuminaireMutants, TwoSidedLightShinesBackwards) {
  const auto mutant = draws::prepare(
      "mutants/two_sided_light",
      draws::scene("{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[.2, "
                   "-.4, 1], [1.6, .3, 1.4], [-.3, 1.2, 1.1]], normal: [-.57, -.34, 2.59], "
                   "radiance: 1}}"));
  EXPECT_EQ(mutant.setup->channels()[0].mean, 0);
  const draws::Sample sample = draws::observe(mutant, 1u << 20)[0];
  EXPECT_NEAR(sample.mean(), 0.481046907316, draws::five * sample.mean_error());
}

TEST(LuminaireMutants, StateTheirOriginalAndDefect) {
  const auto of_luminaire = [](const Entry& entry) {
    return entry.information.original.starts_with("luminaire/");
  };
  EXPECT_EQ(std::ranges::count_if(catalogue(), of_luminaire), 19);
}

}  // namespace
}  // namespace assay
