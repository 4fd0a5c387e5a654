
#include "harness/families/families.h"
#include "harness/theta/ask.h"
#include "tests/harness/questions.h"
#include "tests/harness/refusal.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

std::string suite_of(const std::string& test) {
  return "suite: q\nestimators:\n  darts: {plugin: analytic/dart_throwing}\n"
         "  other: {plugin: analytic/dart_throwing}\n"
         "  scaled: {plugin: mutants/scaled}\n"
         "  original: {plugin: analytic/exponential_uniform}\n"
         "  normal: {plugin: analytic/normal}\n"
         "  hemisphere: {plugin: luminaire/hemisphere, scene: triangle}\n"
         "tests:\n  - " +
         test + "\n";
}

std::string refused(const std::string& test) {
  return refusal([&] { ask_text(suite_of(test)); });
}

const Question question_of(const std::unique_ptr<Asked>& asked) { return asked->questions.at(0); }

TEST(Question, TakesTheAnalyticMeanAndVarianceOfThePlugin) {
  const auto mean = ask_text(suite_of("claim: mean(darts) == analytic"));
  EXPECT_EQ(question_of(mean).theta, &theta_of_means());
  EXPECT_DOUBLE_EQ(question_of(mean).references[0].value, 3.141592653589793);
  const auto variance = ask_text(suite_of("claim: variance(darts) <= analytic"));
  EXPECT_EQ(question_of(variance).theta, &theta_of_variances());
  EXPECT_NEAR(question_of(variance).references[0].value, 2.696766213, 1e-9);
}

TEST(Question, KeepsTheReferencesOwnError) {
  const auto asked = ask_text(suite_of("claim: mean(darts) == 3.1 +- 0.1"));
  EXPECT_EQ(question_of(asked).references[0].standard_error, 0.1);
}

TEST(Question, GivesTwoSourcesOfOneKeyDisjointCopies) {
  const auto same = ask_text(suite_of("claim: mean(darts) == mean(other)"));
  EXPECT_EQ(question_of(same).subjects[0].copy, 0U);
  EXPECT_EQ(question_of(same).subjects[1].copy, 1U);
  const auto mutant = ask_text(suite_of("claim: mean(scaled) == mean(original)"));
  EXPECT_EQ(question_of(mutant).subjects[1].copy, 1U) << "a mutant draws its original's stream";
  const auto apart = ask_text(suite_of("claim: mean(darts) == mean(normal)"));
  EXPECT_EQ(question_of(apart).subjects[1].copy, 0U);
}

std::string of_files(const std::string& claim) {
  return "suite: q\nestimators:\n  first: {plugin: recorded, file: a.txt, column: x}\n"
         "  second: {plugin: recorded, file: a.txt, column: y}\n"
         "  same-way: {plugin: recorded, file: ./a.txt, column: y}\n"
         "  elsewhere: {plugin: recorded, file: b.txt, column: x}\n"
         "tests:\n  - {claim: " +
         claim + "}\n";
}

std::string refused_of_files(const std::string& claim) {
  const Workplace place;
  place.write("a.txt", "# columns: x y\n1 2\n2 3\n3 5\n");
  place.write("b.txt", "# columns: x y\n1 2\n2 3\n3 5\n");
  const Suite suite = load_suite(place.write("suite.yaml", of_files(claim)));
  const auto estimators = prepare_all(suite);
  return refusal([&] { ask(suite.tests[0], estimators, 1); });
}

TEST(Question, RefusesTwoColumnsOfOneFileAsIndependentSamples) {
  for (const char* claim : {"mean(first) == mean(second)", "variance(first) <= variance(second)",
                            "distribution(first) == distribution(second)"}) {
    EXPECT_THAT(refused_of_files(claim), HasSubstr("rows belong together")) << claim;
  }
  EXPECT_THAT(refused_of_files("mean(first) == mean(same-way)"), HasSubstr("rows belong together"))
      << "whatever its path is written like";
  EXPECT_EQ(refused_of_files("mean(first) == mean(elsewhere)"), "(nothing was refused)");
  EXPECT_EQ(refused_of_files("mean(first) == 2"), "(nothing was refused)");
}

TEST(Question, RefusesPrimariesOfObservationsThatAreReadyMade) {
  const Workplace place;
  place.write("a.txt", "1\n2\n");
  const auto refused_with = [&](const std::string& primaries) {
    const Suite suite = load_suite(
        place.write("suite.yaml", "suite: q\nestimators:\n  a: {plugin: recorded, file: a.txt" +
                                      primaries + "}\ntests:\n  - {claim: mean(a) == 1}\n"));
    return refusal([&] { prepare_all(suite); });
  };
  EXPECT_THAT(refused_with(", primaries: 64"), HasSubstr("leave `primaries` out"));
  EXPECT_EQ(refused_with(""), "(nothing was refused)");
}

TEST(Question, AsksASamplersCellsOrOneMarginal) {
  const auto cells = ask_text(suite_of("claim: distribution(hemisphere.direction) == density"));
  EXPECT_EQ(question_of(cells).theta, &theta_of_laws());
  EXPECT_EQ(question_of(cells).channel_name(0), "cell");
  EXPECT_EQ(question_of(cells).subjects[0].purpose, "direction");
  const auto marginal = ask_text(suite_of("claim: distribution(hemisphere.theta) == density"));
  EXPECT_EQ(question_of(marginal).channel_name(0), "theta");
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
