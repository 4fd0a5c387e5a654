#include "harness/draws/sampler_setup.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

const Sampler& sampler_of(const PreparedEstimator& prepared, const std::string& name) {
  for (const NamedSampler& named : prepared.setup->samplers()) {
    if (named.name == name) return *named.sampler;
  }
  throw std::logic_error("no sampler " + name);
}

TEST(DrawText, HoldsEveryNumberThatADrawIsJudgedBy) {
  const PreparedEstimator ward = prepare({.name = "ward", .plugin = "brdf/ward"}, ".");
  const Sampler& sampler = sampler_of(ward, "direction");
  int none = 0;
  for (std::uint64_t index = 0; index < 2000; ++index) {
    const std::string text = draw_text(sampler, key_of(ward, 1, 0, "direction"), index);
    none += text == "no point; weight 0";
    if (text == "no point; weight 0") continue;
    double x, y, z, weight, density, again, evaluation;
    ASSERT_EQ(
        std::sscanf(text.c_str(),
                    "point (%lf, %lf, %lf); weight %lf; density %lf with the draw, %lf at its "
                    "point; evaluate there %lf",
                    &x, &y, &z, &weight, &density, &again, &evaluation),
        7)
        << text;
    EXPECT_NEAR(std::hypot(x, y, z), 1, 1e-12);
    EXPECT_EQ(sampler.density({x, y, z}), again) << "all digits";
    EXPECT_NEAR(weight * density, evaluation, 1e-12 * evaluation);
  }
  // .019819 of the draws are below the horizon: 40 of 2000, and five standard deviations of 6.2.
  EXPECT_NEAR(none, 40, 31);
}

}  // namespace
}  // namespace assay::harness
