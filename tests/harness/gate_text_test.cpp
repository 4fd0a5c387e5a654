#include "harness/plan/gate_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "questions.h"

namespace assay::harness {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The advice for a mean of 1000 observations whose gate of this name is red.
std::string help_for(const std::string& gate) {
  const auto asked = ask_text(R"(suite: gates
estimators:
  it: {plugin: analytic/normal}
tests:
  - {name: test, claim: mean(it) == 0}
)");
  TestOutcome outcome{.question = asked->questions[0]};
  outcome.plan.looks = {{1000}, {1}};
  outcome.gates = {{.name = gate, .value = 4, .limit = 2, .state = "red"}};
  return what_would_help(outcome);
}

TEST(GateText, OfHeavyTailsAdvisesNoMoreObservations) {
  for (const char* gate : {"excess kurtosis of it", "largest deviation of it"}) {
    EXPECT_THAT(help_for(gate), HasSubstr("heavy-tailed"));
    EXPECT_THAT(help_for(gate), HasSubstr("a quantile"));
    EXPECT_THAT(help_for(gate), Not(HasSubstr("secondaries")));
  }
}

// The logarithm of the factor falls like 1 / sqrt(n): (ln 4 / ln 1.25)^2 x 1000 = 38596.
TEST(GateText, OfSkewnessSaysHowManyObservationsWouldHelp) {
  const std::string help = help_for("level factor by skewness");
  EXPECT_THAT(help, HasSubstr("`secondaries` would help"));
  EXPECT_THAT(help, Not(HasSubstr("heavy-tailed")));
}

TEST(GateText, NamesFewOfManyRedGates) {
  std::vector<reports::Gate> gates;
  for (int i = 0; i < 1000; ++i) {
    gates.push_back({.name = "largest deviation, value" + std::to_string(i),
                     .value = 4,
                     .limit = 2,
                     .state = "red"});
  }
  const std::string all = red_gates(gates);
  EXPECT_THAT(all, HasSubstr("value3)"));
  EXPECT_THAT(all, Not(HasSubstr("value4)")));
  EXPECT_THAT(all, HasSubstr("1000 in all"));
  gates.resize(4);
  EXPECT_THAT(red_gates(gates), Not(HasSubstr("in all")));
}

}  // namespace
}  // namespace assay::harness
