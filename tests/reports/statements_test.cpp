#include "reports/record/statements.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/formats/console.h"
#include "reports/formats/json.h"
#include "reports/formats/markdown.h"
#include "reports/formats/read_json.h"
#include "reports/words/columns.h"
#include "reports/words/statement_text.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

Test test_of(const std::string& name, Verdict verdict, Verdict expected = Verdict::pass) {
  Test test;
  test.name = name;
  test.verdict = verdict;
  test.expected = expected;
  test.ok = verdict == expected;
  return test;
}

/// Tests by what they come out as; "surprise" passed and should have failed.
Suite suite_of_verdicts() {
  Suite suite;
  suite.tests = {test_of("pass", Verdict::pass),
                 test_of("kill", Verdict::fail, Verdict::fail),
                 test_of("fail", Verdict::fail),
                 test_of("surprise", Verdict::pass, Verdict::fail),
                 test_of("undecided", Verdict::inconclusive),
                 test_of("invalid", Verdict::invalid),
                 test_of("broken", Verdict::error, Verdict::error),
                 test_of("skipped", Verdict::skipped)};
  return suite;
}

using Names = std::vector<std::string>;

Answer answer_to(const Names& holds, const Names& fails = {}) {
  return answer(suite_of_verdicts(), {.holds = holds, .fails = fails});
}

TEST(Statements, SayOfAFindingHowMuchWasAllowed) {
  reports::Suite suite;
  reports::Test test = test_of("near", Verdict::pass);
  test.channels.resize(1);
  test.channels[0].effect = {.quantity = "relative difference of means",
                             .estimate = 0.003,
                             .low = 0.002,
                             .high = 0.004,
                             .confidence = 0.99,
                             .relative = true};
  suite.tests = {test};
  const std::string strict = findings(suite, {"near"});
  EXPECT_NE(strict.find("+0.3\u00A0%"), std::string::npos) << strict;
  EXPECT_EQ(strict.find("allowed"), std::string::npos) << strict;
  suite.tests[0].allow = 0.005;
  EXPECT_EQ(findings(suite, {"near"}), strict + ", 0.5\u00A0% allowed");
}

TEST(Statements, HoldWhereEveryTestIsAsExpected) {
  EXPECT_EQ(answer_to({"pass"}), Answer::yes);
  EXPECT_EQ(answer_to({"pass", "kill"}), Answer::yes);
}

TEST(Statements, DoNotHoldWhereTestsShowTheContrary) {
  EXPECT_EQ(answer_to({}, {"kill"}), Answer::no);
  EXPECT_EQ(answer_to({}, {"pass"}), Answer::no);
}

TEST(Statements, HoldOnlyOnAConditionWhereTestsShowBoth) {
  EXPECT_EQ(answer_to({"pass"}, {"kill"}), Answer::only_if);
}

TEST(Statements, AreContradictedByAVerdictThatWasNotExpected) {
  EXPECT_EQ(answer_to({"pass", "fail"}), Answer::contradicted);
  EXPECT_EQ(answer_to({"pass"}, {"surprise"}), Answer::contradicted);
  EXPECT_EQ(answer_to({"undecided"}, {"surprise"}), Answer::contradicted);
}

TEST(Statements, AreOpenWhileATestDecidesNothing) {
  for (const char* test : {"undecided", "invalid", "broken", "skipped", "not in the record"}) {
    EXPECT_EQ(answer_to({"pass", test}), Answer::open) << test;
    EXPECT_EQ(answer_to({"pass"}, {test}), Answer::open) << test;
  }
  EXPECT_EQ(answer_to({}), Answer::open);
}

TEST(Statements, AreOpenWhereAnExpectedVerdictIsNotOk) {
  Suite suite = suite_of_verdicts();
  suite.tests[1].ok = false;
  EXPECT_EQ(answer(suite, {.fails = {"kill"}}), Answer::open);
}

TEST(Statements, ListTestsThatNeedALookFirst) {
  std::string order;
  for (const Witness& witness :
       witnesses(suite_of_verdicts(), {"pass", "undecided", "kill", "fail", "gone"}))
    order += witness.name + (witness.test ? " " : "! ");
  EXPECT_EQ(order, "fail undecided gone! pass kill ");
}

TEST(Statements, AreCountedByTheirAnswers) {
  Record record;
  record.suites = {suite_of_verdicts()};
  EXPECT_EQ(statement_count(record), 0U);
  Suite& suite = record.suites[0];
  suite.statements.resize(3);
  suite.statements[0].holds = {"pass"};
  suite.statements[1].fails = {"kill"};
  suite.statements[2].holds = {"kill"};
  EXPECT_EQ(statement_count(record), 3U);
  EXPECT_EQ(statement_totals(record), "3\u00A0statements: 2\u00A0yes, 1\u00A0no.");
}

TEST(Statements, ShowTheIntervalThatTheVerdictRestsOn) {
  const Suite suite = example_record().suites[0];
  const Statement& first = suite.statements[0];
  EXPECT_EQ(whole_answer(suite, first), "yes");
  const std::string shown = finding(suite, witnesses(suite, first.holds)[0]);
  EXPECT_EQ(shown.find("relative difference of means"), 0U) << shown;
  EXPECT_NE(shown.find("% interval)"), std::string::npos) << shown;
  EXPECT_EQ(whole_answer(suite, suite.statements[2]), "only if the cosine is not forgotten");
  EXPECT_EQ(finding(suite, {"gone", {}}), "not run");
  EXPECT_EQ(finding(suite_of_verdicts(), {"undecided", 4}), "? inconclusive");
}

TEST(Statements, OfMoreThanTwoTestsTheRestIsCounted) {
  const std::string text = findings(suite_of_verdicts(), {"pass", "kill", "undecided", "fail"});
  EXPECT_EQ(text.find("fail: ✗ fail; undecided: ? inconclusive; and 2 more"), 0U) << text;
}

TEST(Statements, StandFirstInMarkdown) {
  const Record record = example_record();
  const std::string text = markdown(record);
  EXPECT_LT(text.find("## Statements"), text.find("### ✗ fail"));
  for (const std::string& report : {text, console(record, {.detail = 2})}) {
    EXPECT_NE(report.find("contradicted"), std::string::npos);
    EXPECT_NE(report.find("the cosine is not forgotten"), std::string::npos);
  }
}

TEST(Statements, AreNotMentionedWhereThereAreNone) {
  Record record = example_record();
  for (Suite& suite : record.suites) suite.statements.clear();
  for (const std::string& report : {markdown(record), console(record, {.detail = 2})}) {
    EXPECT_EQ(report.find("Statements"), std::string::npos);
    EXPECT_EQ(report.find("contradicted"), std::string::npos);
  }
}

TEST(Statements, AreReadBackAndAnsweredAgainFromTheVerdicts) {
  Record record = example_record();
  std::string text = json(record);
  EXPECT_NE(text.find(R"("answers": ["yes","no","only if","open","contradicted"])"),
            std::string::npos);
  EXPECT_EQ(read_json(text, "x").suites[0].statements, record.suites[0].statements);
  // A changed answer in the file changes nothing: it is no part of the record.
  text.replace(text.find(R"(["yes","no")"), 6, R"(["open")");
  const Suite read = read_json(text, "x").suites[0];
  EXPECT_EQ(answers(read)[0], "yes");
}

}  // namespace
}  // namespace assay::reports
