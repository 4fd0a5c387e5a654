#include "reports/words/effect.h"

#include "tests/prelude.h"

namespace assay::reports {
namespace {

Effect ratio(double estimate, double low, double high) {
  return {
      "ln(ratio of variances)", std::log(estimate), std::log(low), std::log(high), 0.9998, false};
}

TEST(Effects, ARatioNearOneIsShownInPerCent) {
  EXPECT_EQ(effect_text(ratio(1.0244, 0.918, 1.148)), "+2.44\u00A0% [-8.2\u00A0%, +14.8\u00A0%]");
}

TEST(Effects, ARatioFarFromOneIsShownAsAFactorWithItsInterval) {
  EXPECT_EQ(effect_text(ratio(0.0717, 0.0619, 0.0831)), "×0.0717 [×0.0619, ×0.0831]");
  // One end beyond a factor of two: all three numbers take the same form.
  EXPECT_EQ(effect_text(ratio(1.5, 1.1, 2.5)), "×1.5 [×1.1, ×2.5]");
}

TEST(Effects, AFactorBeyondADoubleIsWrittenFromItsLogarithm) {
  const Effect effect{"ln(ratio of variances)", -2302.585092994046, {}, {}, 0.99, false};
  EXPECT_EQ(effect_text(effect), "×1.0e-1000");
}

TEST(Effects, TheNameOfARatioHasNoLogarithm) {
  EXPECT_EQ(effect_name(ratio(1, 1, 1)), "ratio of variances");
  EXPECT_EQ(effect_name({"ln variance ratio", {}, {}, {}, 0.99, false}), "variance ratio");
  EXPECT_EQ(effect_name({"slope", {}, {}, {}, 0.99, false}), "slope");
}

TEST(Effects, AnIntervalIsNamedByItsConfidence) {
  const Effect effect{"relative difference of means", 0.0031, 0.0012, 0.005, 0.9998, true};
  EXPECT_EQ(named_effect_text(effect),
            "+0.31\u00A0% [+0.12\u00A0%, +0.5\u00A0%] (99.98\u00A0% interval)");
  EXPECT_EQ(named_effect_text({"difference", 2.0, {}, {}, 0.99, false}), "+2");
}

TEST(Effects, TheSizeOfAnEndIsThatOfItsInterval) {
  const Effect effect = ratio(0.97, 0.857, 1.109);
  EXPECT_EQ(interval_text(effect), "[-14.3\u00A0%, +10.9\u00A0%]");
  EXPECT_EQ(size_text(*effect.low, effect), "14.3\u00A0%");
  EXPECT_EQ(size_text(*effect.high, effect), "10.9\u00A0%");
}

TEST(Effects, AnOpenEndIsNotShownAsANumber) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(interval_text({"ln(ratio of variances)", -1.38, -infinity, -1.32, 0.99, false}),
            "[to ×0.267]");
  EXPECT_EQ(interval_text({"difference", 1.0, {}, {}, 0.99, false}), "");
}

// A suite writes it as `detect: 20%`; for a ratio that is ln 1.2.
TEST(Effects, AMarginIsShownInTheFormOfItsEffect) {
  EXPECT_EQ(margin_text(std::log(1.2), ratio(1, 1, 1)), "20\u00A0%");
  EXPECT_EQ(margin_text(std::log(1.2), ratio(3, 2, 4)), "a factor of 1.2");
  EXPECT_EQ(margin_text(std::log(3), ratio(1, 1, 1)), "a factor of 3");
  EXPECT_EQ(margin_text(0.005, {"difference", {}, {}, {}, 0.99, true}), "0.5\u00A0%");
}

}  // namespace
}  // namespace assay::reports
