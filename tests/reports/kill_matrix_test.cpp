#include "reports/words/kill_matrix.h"

#include "reports/report_formats.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

struct Case {
  std::string claim;
  std::string method;
  Verdict verdict = Verdict::fail;
  std::uint64_t secondaries = 100;
  Number detectable = {};
};

Sample sample_of(const std::string& estimator, std::uint64_t secondaries) {
  return {.estimator = estimator, .channel = "value", .primaries = 64, .secondaries = secondaries};
}

Test test_of(const Case& what, const std::vector<std::string>& sources) {
  Test test;
  test.claim = what.claim;
  test.method = what.method;
  test.verdict = what.verdict;
  test.detectable = what.detectable;
  test.channels.resize(1);
  test.channels[0].name = "value";
  test.channels[0].effect.quantity = "relative difference of means";
  test.channels[0].effect.relative = true;
  for (const std::string& source : sources)
    test.samples.push_back(sample_of(source, what.secondaries));
  return test;
}

/// A sound estimator and two mutants of it.
Suite zoo() {
  Suite suite;
  suite.name = "zoo";
  for (const char* name : {"sound", "one", "two"}) {
    suite.estimators.push_back({.name = name, .plugin = std::string("mutants/") + name});
    if (suite.estimators.size() > 1) suite.estimators.back().original = "family/sound";
  }
  return suite;
}

/// The matrix of the tests, whose ids are their places.
KillMatrix matrix_of(Suite& suite) {
  for (std::size_t t = 0; t < suite.tests.size(); ++t) suite.tests[t].id = std::to_string(t);
  return kill_matrix(suite);
}

KillCell only_cell(Suite& suite) { return *matrix_of(suite).rows.at(0).cells.at(0); }

TEST(KillMatrix, ColumnsAreTheTextbooksTestsOfTheClaims) {
  Suite suite = zoo();
  suite.tests = {test_of({"slope(bias(one)) within 0.1 of -1", "slope"}, {"one"}),
                 test_of({"distribution(one.s) == density", "chi-square-fit"}, {"one"}),
                 test_of({"distribution(one) == distribution(sound)", "ks"}, {"one", "sound"}),
                 test_of({"variance(one) == variance(sound)", "influence-t"}, {"one", "sound"}),
                 test_of({"variance(one) <= 2", "influence-t"}, {"one"}),
                 test_of({"mean(one) == mean(sound)", "skewness-corrected-t"}, {"one", "sound"}),
                 test_of({"mean(one) within 1% of analytic", "tost"}, {"one"}),
                 test_of({"mean(two) == analytic", "image"}, {"two"})};
  const KillMatrix matrix = matrix_of(suite);
  EXPECT_EQ(matrix.methods, (std::vector<std::string>{"t", "Welch", "chi-square", "F", "KS", "fit",
                                                      "image", "slope"}));
  ASSERT_EQ(matrix.rows.size(), 2u);
  EXPECT_EQ(matrix.rows[0].mutant, "one");
  EXPECT_EQ(matrix.rows[0].cells[0]->test, "6");
  EXPECT_FALSE(matrix.rows[0].cells[6]);
  EXPECT_FALSE(matrix.rows[1].cells[0]);
  EXPECT_EQ(matrix.rows[1].cells[6]->test, "7");
}

TEST(KillMatrix, SoundEstimatorsSkippedTestsAndTestsWithoutASampleHaveNoRow) {
  Suite suite = zoo();
  suite.tests = {test_of({"mean(sound) == analytic", "t", Verdict::pass}, {"sound"}),
                 test_of({"mean(one) == analytic", "t", Verdict::skipped}, {"one"}),
                 test_of({"mean(two) == analytic", "t"}, {})};
  EXPECT_TRUE(kill_matrix(suite).rows.empty());
  EXPECT_FALSE(is_worth_showing(kill_matrix(suite)));
}

TEST(KillMatrix, SamplesArePrimariesOfTheMutantAlone) {
  Suite suite = zoo();
  suite.tests = {
      test_of({.claim = "mean(sound) == mean(one)", .method = "welch"}, {"sound", "one"})};
  suite.tests[0].samples[0].secondaries = 7;
  suite.tests[0].samples[1].secondaries = 50;
  EXPECT_EQ(only_cell(suite).text, "3200");  // 64 * 50
}

TEST(KillMatrix, TheKillOfFewestSamplesStandsForAMethod) {
  Suite suite = zoo();
  suite.tests = {test_of({"mean(one) == 1", "t", Verdict::pass, 10, 0.1}, {"one"}),
                 test_of({"mean(one) == 1", "t", Verdict::fail, 5000}, {"one"}),
                 test_of({"mean(one) == 1", "t", Verdict::fail, 40}, {"one"}),
                 test_of({"mean(one) == 1", "t", Verdict::error, 5}, {"one"})};
  EXPECT_EQ(only_cell(suite).test, "2");
}

TEST(KillMatrix, OfSurvivalsTheOneThatWouldHaveFoundLeastStandsForAMethod) {
  Suite suite = zoo();
  suite.tests = {test_of({"mean(one) == 1", "t", Verdict::inconclusive, 5}, {"one"}),
                 test_of({"mean(one) == 1", "t", Verdict::pass, 500}, {"one"}),
                 test_of({"mean(one) == 1", "t", Verdict::pass, 100, 0.05}, {"one"}),
                 test_of({"mean(one) == 1", "t", Verdict::pass, 200, 0.01}, {"one"})};
  EXPECT_EQ(only_cell(suite).test, "3");
  EXPECT_EQ(only_cell(suite).text, "< 1\u00A0%");
  EXPECT_EQ(
      only_cell(suite).sentence,
      "survives 12.8\u00A0k\u00A0samples: an effect of 1\u00A0% or more would have been found");
}

TEST(KillMatrix, EveryVerdictHasItsWords) {
  Suite suite = zoo();
  const auto words = [&](const Case& what) {
    suite.tests = {test_of(what, {"one"})};
    return only_cell(suite).text + "; " + only_cell(suite).sentence;
  };
  EXPECT_EQ(words({"mean(one) == 1", "t", Verdict::fail}), "6400; killed by 6400\u00A0samples");
  EXPECT_EQ(words({"mean(one) == 1", "t", Verdict::pass}), "survives; survives 6400\u00A0samples");
  EXPECT_EQ(words({"mean(one) == 1", "t", Verdict::error}),
            "not finite; not finite among 6400\u00A0samples");
  EXPECT_EQ(words({"mean(one) == 1", "t", Verdict::inconclusive}),
            "undecided; inconclusive after 6400\u00A0samples");
  EXPECT_EQ(words({"mean(one) == 1", "t", Verdict::invalid}),
            "invalid; invalid after 6400\u00A0samples");
}

TEST(KillMatrix, ALogarithmOfARatioIsShownAsTheRatio) {
  Suite suite = zoo();
  suite.tests = {
      test_of({"variance(one) <= 1", "chi-square", Verdict::pass, 100, 0.0953101798}, {"one"})};
  suite.tests[0].channels[0].effect.quantity = "ln(variance over the reference)";
  EXPECT_EQ(only_cell(suite).text, "< 10\u00A0%");
}

TEST(KillMatrix, TotalsCountPluginsOnceAndRowsByMethod) {
  Suite suite = zoo();
  suite.estimators[2].plugin = suite.estimators[1].plugin;
  suite.tests = {test_of({"mean(one) == 1", "t", Verdict::pass, 10}, {"one"}),
                 test_of({"mean(two) == 1", "t", Verdict::fail, 10}, {"two"}),
                 test_of({"variance(two) <= 1", "chi-square", Verdict::pass, 10}, {"two"})};
  EXPECT_EQ(kill_matrix(suite).totals,
            "1 of 1 mutants are killed. Rows that each method kills: t 1 of 2, chi-square 0 of 1.");
}

Suite two_methods() {
  Suite suite = zoo();
  suite.tests = {test_of({"mean(one) == 1", "t", Verdict::fail, 20000}, {"one"}),
                 test_of({"variance(one) <= 1", "chi-square", Verdict::pass, 10, 0.5}, {"one"})};
  return suite;
}

TEST(KillMatrix, ReportsShowItOnlyWhereAMutantWasTestedByTwoMethods) {
  Record record;
  record.suites = {two_methods()};
  record.suites[0].tests.pop_back();
  EXPECT_THAT(markdown(record), Not(HasSubstr("Which method sees which defect")));
  EXPECT_THAT(console(record, {.detail = 2}), Not(HasSubstr("mutants are killed")));
}

}  // namespace
}  // namespace assay::reports
