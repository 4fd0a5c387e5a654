#include "harness/suite/suite.h"
#include "reports/words/statements.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

using Names = std::vector<std::string>;

constexpr const char* suite_text = R"(suite: small
estimators:
  darts: {plugin: analytic/dart_throwing}
  ramp: {plugin: analytic/ramp}
tests:
  - {claim: mean(darts) == analytic, secondaries: 2000}
  - {claim: mean(darts) == 2 * mean(darts), name: twice itself, secondaries: 2000, expect: fail}
  - {claim: mean(ramp) == analytic, secondaries: 200}
  - {claim: variance(darts) < 0.5 * variance(darts), secondaries: 2000, expect: fail}
statements:
  - {text: Both are right., source: a talk, holds: ["mean(*) == analytic"]}
  - {text: Darts are half of what they are., source: "a talk, slide 2", fails: [twice itself]}
  - text: A test is named by its claim, though an asterisk stands in it.
    source: here
    condition: it is written like that
    holds: [mean(ramp) == analytic, "mean(ramp)*"]
    fails: [variance(darts) < 0.5 * variance(darts)]
)";

TEST(SuiteStatements, NamesTestsByNameClaimOrGlob) {
  const Workplace place;
  const Suite suite = load_suite(place.write("small.yaml", suite_text));
  ASSERT_EQ(suite.statements.size(), 3U);
  EXPECT_EQ(suite.statements[0].text, "Both are right.");
  EXPECT_EQ(suite.statements[0].holds,
            (Names{"mean(darts) == analytic", "mean(ramp) == analytic"}));
  EXPECT_EQ(suite.statements[1].source, "a talk, slide 2");
  EXPECT_EQ(suite.statements[1].fails, Names{"twice itself"});
  EXPECT_EQ(suite.statements[2].condition, "it is written like that");
  EXPECT_EQ(suite.statements[2].holds, Names{"mean(ramp) == analytic"});
  EXPECT_EQ(suite.statements[2].fails, Names{"variance(darts) < 0.5 * variance(darts)"});
  EXPECT_EQ(suite.statements[2].line, 13);
}

// Seed 1. The doubled mean and the halved variance are off by 60 standard errors and more. A right
// mean fails with probability 0.01 at most.
TEST(SuiteStatements, AreAnsweredByTheVerdictsOfARun) {
  const reports::Record record = run_text(suite_text, {.threads = 1});
  ASSERT_EQ(record.suites.at(0).statements.size(), 3U);
  EXPECT_EQ(reports::answers(record.suites[0]), (Names{"yes", "no", "only if"}));
  EXPECT_EQ(record.suites[0].statements[2].line, 13);
}

TEST(SuiteStatements, AreLeftOutWhereNoTestOfTheirsIsRun) {
  const reports::Record record =
      run_text(suite_text, {.threads = 1, .selection = {.filters = {"suite/mean(ramp)*"}}});
  const reports::Suite& suite = record.suites.at(0);
  ASSERT_EQ(suite.statements.size(), 2U);
  EXPECT_EQ(suite.statements[0].text, "Both are right.");
  EXPECT_EQ(reports::answers(suite), (Names{"open", "open"}));
}

}  // namespace
}  // namespace assay::harness
