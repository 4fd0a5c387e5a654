// Each mutant draws other numbers than its original and has the bias that its defect brings.

#include "tests/estimators/draws.h"
#include "tests/prelude.h"

namespace assay {
namespace {

using namespace assay::draws;

/// True if a sampler misreports its draws, but the draws are right. Claims of consistency see it;
/// the mean need not move.
bool only_misreports(const std::string& mutant) {
  return mutant == "mutants/ward_density_sector" || mutant == "mutants/ward_weight_mirrored";
}

TEST(BrdfMutants, AreBiasedAndActivated) {
  int count = 0;
  for (const Entry& entry : catalogue()) {
    const Information& mutant = entry.information;
    if (!mutant.original.starts_with("brdf/") || only_misreports(mutant.name)) continue;
    ++count;
    const auto prepared = prepare(mutant.name);
    const auto original = prepare(mutant.original);
    EXPECT_EQ(prepared.key, original.key) << mutant.name;
    const Channel claimed = prepared.setup->channels()[0];
    EXPECT_EQ(claimed.mean, original.setup->channels()[0].mean) << mutant.name;
    const Sample sample = observe(prepared, 200000)[0];
    EXPECT_NE(sample.values, observe(original, 200000)[0].values) << mutant.name;
    // The subtlest, the exponent without + 1, lies 0.8 % off, 7 standard errors of this sample.
    EXPECT_GT(std::abs(sample.mean() - *claimed.mean), five * sample.mean_error()) << mutant.name;
  }
  EXPECT_EQ(count, 13);
}

}  // namespace
}  // namespace assay
