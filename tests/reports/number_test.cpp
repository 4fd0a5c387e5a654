#include "reports/words/number.h"

#include "tests/prelude.h"

namespace assay::reports {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Numbers, HumanFormHasFourDigits) {
  EXPECT_EQ(human(0.481046907316), "0.481");
  EXPECT_EQ(human(12345.6), "12350");
  EXPECT_EQ(human(1000, 2), "1000");
  EXPECT_EQ(human(-3.14159), "-3.142");
  EXPECT_EQ(human(0), "0");
  EXPECT_EQ(human(-0.0), "0");
  EXPECT_EQ(human(std::nullopt), "n/a");
  EXPECT_EQ(human(std::nan("")), "NaN");
  EXPECT_EQ(human(-infinity), "-Infinity");
}

TEST(Numbers, EffectsCarryASign) {
  EXPECT_EQ(with_sign(0.0031, true), "+0.31\u00A0%");
  EXPECT_EQ(with_sign(-0.25, false), "-0.25");
  EXPECT_EQ(with_sign(0, true), "0\u00A0%");
}

TEST(Numbers, SmallPValuesComeFromTheirLogarithm) {
  EXPECT_EQ(p_text(0.0, -1204.64), "2.3e-1205");
  EXPECT_EQ(p_text(0.0, -7.8e307), "below 1e-1000000");
  EXPECT_EQ(p_text(2.3e-45, std::nullopt), "2.3e-45");
  EXPECT_EQ(p_text(std::nullopt, -2.0), "0.01");
  EXPECT_EQ(p_text(0.0431, std::nullopt), "0.043");
  EXPECT_EQ(p_text(9.97e-7, std::nullopt), "1.0e-6");
  EXPECT_EQ(p_text(std::nullopt, std::nullopt), "n/a");
}

TEST(Numbers, AnExponentThatNobodyReadsIsLeftOut) {
  EXPECT_EQ(p_text(0.0, -1e300), "below 1e-1000000");
  EXPECT_EQ(p_text(0.0, -999999.5), "3.2e-1000000");
}

TEST(Numbers, APValueNearOneIsNotRoundedToOne) {
  EXPECT_EQ(p_text(0.99996, std::nullopt), "1 - 4e-05");
  EXPECT_EQ(p_text(1.0, std::nullopt), "1");
}

TEST(Numbers, CountsAreShortOrGrouped) {
  EXPECT_EQ(count_text(0), "0");
  EXPECT_EQ(count_text(9999), "9999");
  EXPECT_EQ(count_text(10000), "10.0\u00A0k");
  EXPECT_EQ(count_text(1048576), "1.05\u00A0M");
  EXPECT_EQ(count_text(999999), "1.00\u00A0M");
  EXPECT_EQ(count_text(18446744073709551615u), "18.4\u00A0E");
  EXPECT_EQ(in_commas(1048576), "1,048,576");
  EXPECT_EQ(in_commas(12), "12");
}

TEST(Numbers, DurationsChooseTheirUnit) {
  EXPECT_EQ(duration(0), "0\u00A0s");
  EXPECT_EQ(duration(0.0041), "4.1\u00A0ms");
  EXPECT_EQ(duration(12.34), "12.3\u00A0s");
  EXPECT_EQ(duration(125), "2\u00A0min\u00A05\u00A0s");
  EXPECT_EQ(duration(12000), "3\u00A0h\u00A020\u00A0min");
}

TEST(Numbers, AConfidenceNearOneKeepsTheDigitsThatTellItFromOne) {
  EXPECT_EQ(confidence_text(0.95), "95\u00A0%");
  EXPECT_EQ(confidence_text(0.99), "99\u00A0%");
  EXPECT_EQ(confidence_text(0.999825), "99.98\u00A0%");
  EXPECT_EQ(confidence_text(1 - 4e-6), "99.9996\u00A0%");
}

TEST(Numbers, PowersOfTenReachBeyondADouble) {
  EXPECT_EQ(scientific(-811.6), "2.5e-812");
  EXPECT_EQ(scientific(1000), "1.0e1000");
  EXPECT_EQ(scientific(-std::numeric_limits<double>::infinity()), "0");
}

TEST(Numbers, ANounAgreesWithItsCount) {
  EXPECT_EQ(counted(1, "primary", "primaries"), "1\u00A0primary");
  EXPECT_EQ(counted(0, "primary", "primaries"), "0\u00A0primaries");
  EXPECT_EQ(counted(12500, "primary", "primaries"), "12.5\u00A0k\u00A0primaries");
}

TEST(Numbers, AnUnderflownPValueIsABound) {
  EXPECT_EQ(p_text(0.0, {}), "below 1e-307");
  EXPECT_EQ(p_text(5e-324, {}), "below 1e-307");
  EXPECT_EQ(p_text(5e-324, -1204.64), "2.3e-1205");
}

}  // namespace
}  // namespace assay::reports
