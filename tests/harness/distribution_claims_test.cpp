// Claims about laws beyond the default methods, from YAML to verdict: what is true passes, what is
// broken fails, what a method cannot answer is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "questions.h"
#include "refusal.h"
#include "running.h"

namespace assay::harness {
namespace {

using reports::Verdict;

const std::string estimators = R"(suite: claims
alpha: 0.0001
beta: 0.0001
estimators:
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  again: {plugin: analytic/normal, mean: 2, primaries: 1}
  importance: {plugin: analytic/exponential_importance}
  ward: {plugin: brdf/ward}
  redrawn: {plugin: mutants/ward_redrawn}
tests:
  - )";

reports::Test tested(const std::string& test) {
  return run_text(estimators + test + "\n", {.threads = 1}).suites[0].tests[0];
}

Verdict verdict_of(const std::string& test) {
  const reports::Test result = tested(test);
  testing::Test::RecordProperty("message", result.message);
  return result.verdict;
}

std::string refused(const std::string& test) {
  return refusal([&] { run_text(estimators + test + "\n"); });
}

// Verdicts below are right with probability 1 - alpha - beta = 0.9998 at least, with the seed 1.

TEST(AndersonDarlingClaim, HoldsForTheLawAndForADeclaredDensity) {
  const reports::Test law = tested(
      "{claim: 'distribution(normal) == normal(2, 1)', test: anderson-darling, detect: 0.05}");
  EXPECT_EQ(law.verdict, Verdict::pass) << law.message;
  EXPECT_EQ(law.method, "anderson-darling");
  EXPECT_FALSE(law.power.has_value()) << "no formula";
  EXPECT_FALSE(law.detectable.has_value());
  ASSERT_TRUE(law.channels[0].effect.high.has_value());
  EXPECT_LT(*law.channels[0].effect.high, 0.05) << "the interval is of the largest distance";
  EXPECT_EQ(verdict_of("{claim: distribution(importance.x.x) == density, test: anderson-darling, "
                       "secondaries: 20000}"),
            Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: distribution(ward.direction.theta) == density, test: "
                       "anderson-darling, secondaries: 20000}"),
            Verdict::pass)
      << "missing mass included";
}

// A2 / n tends to .054 for the first: A2 = 160 at 3000 values, where p < 1e-60.
TEST(AndersonDarlingClaim, FailsForWrongTailsAndForABrokenSampler) {
  EXPECT_EQ(verdict_of("{claim: 'distribution(normal) == normal(2, 1.5)', test: anderson-darling, "
                       "secondaries: 3000}"),
            Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: distribution(redrawn.direction.theta) == density, test: "
                       "anderson-darling, secondaries: 20000}"),
            Verdict::fail);
}

TEST(AndersonDarlingClaim, IsRefusedWhereItHasNoAnswer) {
  EXPECT_EQ(refused("{claim: 'distribution(normal) == normal(2, 1)', test: anderson-darling, "
                    "allow: 0.01}"),
            "11:5: `anderson-darling` tests that two laws are the same and knows no distance to "
            "`allow` between them; leave `allow` out, or test by `ks`");
  EXPECT_THAT(refused("{claim: distribution(normal) == distribution(again), test: "
                      "anderson-darling}"),
              testing::StartsWith("11:5: `test: anderson-darling` does not answer this claim"));
  EXPECT_EQ(refused("{claim: distribution(ward.direction) == density, test: anderson-darling}"),
            "11:5: `test: anderson-darling` does not answer this claim; there is `chi-square-fit`");
  EXPECT_EQ(verdict_of("{claim: 'distribution(normal) == normal(2, 1)', test: anderson-darling, "
                       "secondaries: 4}"),
            Verdict::invalid)
      << "fewer than 5 values";
}

}  // namespace
}  // namespace assay::harness
