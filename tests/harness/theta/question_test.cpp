#include "tests/harness/prelude.h"
#include "tests/harness/questions.h"
#include "tests/harness/table.h"

namespace assay::harness {
namespace {

std::string suite_of(const std::string& test) { return suite_with("questions", test); }

std::string refused(const std::string& test) {
  return refusal([&] { ask_text(suite_of(test)); });
}

const Question question_of(const std::unique_ptr<Asked>& asked) { return asked->questions.at(0); }

TEST(Question, GivesTwoSourcesOfOneKeyDisjointCopies) {
  const auto same = ask_text(suite_of("claim: mean(darts) == mean(other)"));
  EXPECT_EQ(question_of(same).subjects[0].copy, 0U);
  EXPECT_EQ(question_of(same).subjects[1].copy, 1U);
  const auto mutant = ask_text(suite_of("claim: mean(scaled) == mean(original)"));
  EXPECT_EQ(question_of(mutant).subjects[1].copy, 1U) << "a mutant draws its original's stream";
  const auto apart = ask_text(suite_of("claim: mean(darts) == mean(normal)"));
  EXPECT_EQ(question_of(apart).subjects[1].copy, 0U);
}

// Nothing is a part of zero, exponents have no per cent, and a margin as large may be meant.
TEST(Question, TakesAMarginThatMayBeMeant) {
  for (const char* test :
       {"{claim: mean(darts) == 0, detect: 5}", "{claim: mean(darts) within 5 of 0}",
        "{claim: mean(darts) == 3, detect: 3}", "{claim: mean(darts) == 3, detect: 167%}",
        "{claim: mean(darts) == 7 * mean(darts), detect: 5}",
        "{claim: slope(bias(darts)) within 5 of -1, over: {primaries: [8, 16]}}"}) {
    EXPECT_EQ(refused(test), "(nothing was refused)") << test;
  }
}

TEST(Question, GivesLawsADefaultWhereNothingSaysHowManyObservations) {
  const auto detect_of = [](const std::string& test) {
    const auto asked = ask_text(suite_of(test));
    return question_of(asked).test->detect.value_or(Margin{}).value;
  };
  for (const char* claim :
       {"distribution(hemisphere.direction) == density",
        "distribution(hemisphere.theta) == density", "distribution(normal) == normal(2, 1)",
        "distribution(normal) == distribution(darts)"}) {
    const std::string head = "{claim: '" + std::string(claim) + "'";
    EXPECT_EQ(detect_of(head + "}"), 0.05) << claim;
    EXPECT_EQ(detect_of(head + ", allow: 0.01, budget: 1000}"), 0.05) << claim;
    EXPECT_EQ(detect_of(head + ", detect: 0.2}"), 0.2) << claim;
    EXPECT_EQ(detect_of(head + ", secondaries: 100}"), 0) << claim;
  }
  EXPECT_EQ(detect_of("{claim: mean(darts) == 3}"), 0);
  EXPECT_EQ(detect_of("{claim: 'quantile(darts, 0.5) == 3'}"), 0);
  EXPECT_THAT(refused("{claim: 'distribution(normal) == normal(0, 1)', allow: 0.05}"),
              HasSubstr("which is 0.05 by default; give a larger `detect`"));
}

}  // namespace
}  // namespace assay::harness
