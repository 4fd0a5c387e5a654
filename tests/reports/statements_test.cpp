#include "reports/words/statements.h"

#include "reports/report_formats.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

Test test_of(const std::string& name, Verdict verdict, Verdict expected = Verdict::pass) {
  Test test = judged(verdict, expected);
  test.name = name;
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

TEST(Statements, SayOfAFindingHowMuchWasAllowed) {
  reports::Suite suite;
  reports::Test test = test_of("near", Verdict::pass);
  test.channels = {channel(mean_effect(0.003, 0.001))};
  suite.tests = {test};
  const std::string strict = findings(suite, {"near"});
  EXPECT_THAT(strict, AllOf(HasSubstr("+0.3\u00A0%"), Not(HasSubstr("allowed"))));
  suite.tests[0].allow = 0.005;
  EXPECT_EQ(findings(suite, {"near"}), strict + ", 0.5\u00A0% allowed");
}

TEST(Statements, AreAnsweredByTheVerdictsOfTheirTests) {
  struct Case {
    std::vector<std::string> holds, fails;
    Answer answer;
  };
  std::vector<Case> cases{{{"pass"}, {}, Answer::yes},
                          {{"pass", "kill"}, {}, Answer::yes},
                          {{}, {"kill"}, Answer::no},
                          {{}, {"pass"}, Answer::no},
                          {{"pass"}, {"kill"}, Answer::only_if},
                          {{"pass", "fail"}, {}, Answer::contradicted},
                          {{"pass"}, {"surprise"}, Answer::contradicted},
                          {{"undecided"}, {"surprise"}, Answer::contradicted},
                          {{}, {}, Answer::open}};
  for (const char* name : {"undecided", "invalid", "broken", "skipped", "not in the record"}) {
    cases.push_back({{"pass", name}, {}, Answer::open});
    cases.push_back({{"pass"}, {name}, Answer::open});
  }
  for (const auto& [holds, fails, expected] : cases) {
    EXPECT_EQ(answer(suite_of_verdicts(), {.holds = holds, .fails = fails}), expected)
        << PrintToString(holds) << PrintToString(fails);
  }
}

TEST(Statements, AreOpenWhereAnExpectedVerdictIsNotOk) {
  Suite suite = suite_of_verdicts();
  suite.tests[1].ok = false;
  EXPECT_EQ(answer(suite, {.fails = {"kill"}}), Answer::open);
}

TEST(Statements, ListTestsThatNeedALookFirst) {
  for (const auto& [late, early] : {std::pair("pass", "undecided"), std::pair("kill", "gone"),
                                    std::pair("undecided", "fail"), std::pair("pass", "fail")})
    EXPECT_THAT(findings(suite_of_verdicts(), {late, early}),
                testing::StartsWith(std::string(early) + ": "));
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

TEST(Statements, WithoutAFindingShowTheVerdict) {
  EXPECT_EQ(findings(suite_of_verdicts(), {"gone"}), "gone: not run");
  EXPECT_EQ(findings(suite_of_verdicts(), {"undecided"}), "undecided: ? inconclusive");
}

TEST(Statements, OfMoreThanTwoTestsTheRestIsCounted) {
  const std::string text = findings(suite_of_verdicts(), {"pass", "kill", "undecided", "fail"});
  EXPECT_EQ(text.find("fail: ✗ fail; undecided: ? inconclusive; and 2 more"), 0U) << text;
}

TEST(Statements, AreNotMentionedWhereThereAreNone) {
  Record record = example_record();
  for (Suite& suite : record.suites) suite.statements.clear();
  for (const std::string& report : {markdown(record), console(record, {.detail = 2})}) {
    EXPECT_THAT(report, Not(ContainsRegex("Statements|contradicted")));
  }
}

TEST(Statements, AreAnsweredAgainFromTheVerdictsOfASavedRecord) {
  std::string text = json(example_record());
  text.replace(text.find(R"(["yes","no")"), 6, R"(["open")");
  EXPECT_EQ(answers(read_json(text, "x").suites[0])[0], "yes");
}

}  // namespace
}  // namespace assay::reports
