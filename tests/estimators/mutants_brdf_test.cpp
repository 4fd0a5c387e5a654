// Each mutant draws other numbers than its original and has the bias that its defect brings.

#include <gtest/gtest.h>

#include "tests/estimators/draws.h"

namespace assay {
namespace {

using namespace assay::draws;

constexpr double ward_albedo = 0.564185341;
constexpr double ward_mass = 0.980180621;
constexpr double ashikhmin_shirley_albedo = 0.373216904;
constexpr double ashikhmin_shirley_mass = 0.916368748;

struct Bias {
  const char* mutant;
  double mean;  ///< of an independent program, to `digits`
  double digits;
};

// False alarm: 7 comparisons at 1e-6 each. A single quadrant and the like are known to three
// decimals from simulations of other code; redrawing divides by the mass above the horizon.
TEST(BrdfMutants, HaveTheBiasOfTheirDefect) {
  for (const Bias& expected :
       {Bias{"mutants/ward_single_quadrant", 0.767, 5e-4},
        Bias{"mutants/ward_uniform_azimuth", 0.605, 5e-4},
        Bias{"mutants/ward_redrawn", ward_albedo / ward_mass, 1e-8},
        Bias{"mutants/ashikhmin_shirley_single_quadrant", 0.499, 5e-4},
        Bias{"mutants/ashikhmin_shirley_unmirrored", 0.408, 5e-4},
        Bias{"mutants/ashikhmin_shirley_exponent", 0.993 * ashikhmin_shirley_albedo, 4e-4},
        Bias{"mutants/ashikhmin_shirley_redrawn", ashikhmin_shirley_albedo / ashikhmin_shirley_mass,
             1e-8}}) {
    const Sample sample = observe(prepare(expected.mutant), 400000)[0];
    EXPECT_NEAR(sample.mean(), expected.mean, expected.digits + five * sample.mean_error())
        << expected.mutant;
  }
}

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
