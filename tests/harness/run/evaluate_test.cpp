#include "harness/run/evaluate.h"

#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

reports::Test judged_text(const std::string& estimator, const std::string& test) {
  return run_test("suite: one\nestimators:\n  it: {plugin: " + estimator + "}\ntests:\n  - {" +
                  test + "}\n");
}

TEST(Evaluate, BinomialTestsQuoteTheirOwnPower) {
  const reports::Test test = judged_text("analytic/dart_throwing, primaries: 1",
                                         "claim: mean(it) == analytic, detect: 2%");
  EXPECT_EQ(test.method, "binomial");
  EXPECT_EQ(test.verdict, Verdict::pass);
  ASSERT_TRUE(test.power && test.detectable);
  EXPECT_GE(*test.power, 0.99);
  EXPECT_LE(*test.detectable, 0.02);
}

TEST(Evaluate, ForcedMethodIsNotInvalidatedByItsGates) {
  const reports::Test test = judged_text("analytic/heavy_tail, primaries: 1",
                                         "claim: mean(it) == analytic, secondaries: 100, test: t");
  EXPECT_NE(test.verdict, Verdict::invalid);
  EXPECT_TRUE(std::any_of(test.gates.begin(), test.gates.end(),
                          [](const reports::Gate& gate) { return gate.state == "red"; }));
}

// Its range is that number but for rounding: nothing unseen can move its mean.
TEST(Evaluate, ZeroVarianceInADeclaredRangePassesAtItsFirstLook) {
  const reports::Test test =
      judged_text("analytic/zero_variance", "claim: mean(it) == analytic, detect: 0.5%");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_LE(test.samples[0].secondaries, 1000);
}

}  // namespace
}  // namespace assay::harness
