#include "harness/plan/gate_text.h"

#include "harness/plan/looks.h"
#include "tests/harness/questions.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

/// The advice for a mean of 1000 observations whose gate of this name is red.
std::string help_for(const std::string& kind, const std::string& where = "") {
  const auto asked = ask_text(R"(suite: gates
estimators:
  it: {plugin: analytic/normal}
tests:
  - {name: test, claim: mean(it) == 0}
)");
  TestOutcome outcome{.question = asked->questions[0]};
  outcome.plan.looks = one_look(1000, outcome.place.share);
  outcome.gates = {
      gate_of(reports::Gate{.name = kind, .value = 4, .limit = 2, .state = "red"}, where)};
  return what_would_help(outcome);
}

TEST(GateText, OfHeavyTailsAdvisesNoMoreObservations) {
  const std::string help = help_for("excess kurtosis", " of it");
  EXPECT_THAT(help, HasSubstr("heavy-tailed"));
  EXPECT_THAT(help, HasSubstr("a quantile"));
  EXPECT_THAT(help, Not(HasSubstr("secondaries")));
}

// The logarithm of the factor falls like 1 / sqrt(n): (ln 4 / ln 1.25)^2 x 1000 = 38596.
TEST(GateText, OfSkewnessSaysHowManyObservationsWouldHelp) {
  const std::string help = help_for("level factor by skewness");
  EXPECT_THAT(
      help, HasSubstr("about 39000 `secondaries` would do: no test knows of a rare bright value"));
  EXPECT_THAT(help, Not(HasSubstr("heavy-tailed")));
}

// A share of .5: nine times as many others leave it a tenth.
TEST(GateText, OfOneObservationSaysHowManyOthersWouldDo) {
  const auto asked = ask_text(
      "suite: gates\nestimators:\n  it: {plugin: analytic/normal}\ntests:\n"
      "  - {name: test, claim: mean(it) == 0}\n");
  TestOutcome outcome{.question = asked->questions[0]};
  outcome.plan.looks = one_look(1000, outcome.place.share);
  outcome.gates = {gate_of(reports::Gate{
      .name = "share of one observation", .value = 0.5, .limit = 0.5, .state = "red"})};
  EXPECT_THAT(what_would_help(outcome), HasSubstr("about 9000 `secondaries` would do"));
}

TEST(GateText, NamesFewOfManyRedGates) {
  std::vector<Gate> gates;
  for (int i = 0; i < 1000; ++i) {
    gates.push_back(
        gate_of(reports::Gate{.name = "excess kurtosis", .value = 4, .limit = 2, .state = "red"},
                ", value" + std::to_string(i)));
  }
  const std::string all = red_gates(gates);
  EXPECT_THAT(all, HasSubstr("value3)"));
  EXPECT_THAT(all, Not(HasSubstr("value4)")));
  EXPECT_THAT(all, HasSubstr("1000 gates are red in all"));
  gates.resize(4);
  EXPECT_THAT(red_gates(gates), Not(HasSubstr("in all")));
}

}  // namespace
}  // namespace assay::harness
