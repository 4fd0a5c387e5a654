#include "harness/plan/outcome.h"
#include "tests/harness/questions.h"

namespace assay::harness {
namespace {

/// The advice for a mean of 1000 observations with this red gate.
std::string help_for(const Gate& gate) {
  const auto asked = ask_text(
      "suite: gates\nestimators: {it: {plugin: analytic/normal}}\n"
      "tests: [{name: test, claim: mean(it) == 0}]\n");
  TestOutcome outcome{.question = asked->questions[0]};
  outcome.plan.looks = one_look(1000, outcome.place.share);
  outcome.gates = {gate};
  return what_would_help(outcome).text;
}

Gate red(const std::string& kind, double value = 4, double limit = 2,
         const std::string& where = "") {
  return gate_of(kind, value, limit, "red", where);
}

TEST(GateText, OfHeavyTailsAdvisesNoMoreObservations) {
  const std::string help = help_for(red("excess kurtosis", 4, 2, " of it"));
  EXPECT_THAT(help, HasSubstr("heavy-tailed"));
  EXPECT_THAT(help, HasSubstr("a quantile"));
  EXPECT_THAT(help, Not(HasSubstr("secondaries")));
}

// The logarithm of the factor falls like 1 / sqrt(n): (ln 4 / ln 1.25)^2 x 1000 = 38596.
TEST(GateText, OfSkewnessSaysHowManyObservationsWouldHelp) {
  const std::string help = help_for(red("level factor by skewness"));
  EXPECT_THAT(help,
              HasSubstr("`secondaries: 39000` may do. Without a declared range a test needs"));
  EXPECT_THAT(help, Not(HasSubstr("heavy-tailed")));
}

// A share of .5: nine times as many others leave it a tenth. Effective observations are taken to
// grow like the root of all, and twice the limit is wanted: (64 / 16)^2 times 1000.
TEST(GateText, OfOneObservationSaysHowManyOthersWouldDo) {
  EXPECT_THAT(help_for(red("share of one observation", 0.5, 0.5)),
              HasSubstr("`secondaries: 9000` may do"));
  EXPECT_THAT(help_for(red("effective observations", 16, 32)),
              HasSubstr("`secondaries: 16000` may do"));
  EXPECT_THAT(help_for(red("effective observations", 3, 32)), HasSubstr("heavy-tailed"));
}

TEST(GateText, NamesFewOfManyRedGates) {
  std::vector<Gate> gates;
  for (int i = 0; i < 1000; ++i) {
    gates.push_back(red("excess kurtosis", 4, 2, ", value" + std::to_string(i)));
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
