#include "reports/words/summary.h"

#include "tests/prelude.h"
#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

std::string text(Verdict verdict, Verdict expected) {
  reports::Test test;
  test.verdict = verdict;
  test.expected = expected;
  test.ok = verdict == expected;
  return verdict_text(test);
}

TEST(Verdicts, AVerdictSaysWhatWasExpectedOfIt) {
  EXPECT_EQ(text(Verdict::pass, Verdict::pass), "pass");
  EXPECT_EQ(text(Verdict::fail, Verdict::pass), "fail");
  EXPECT_EQ(text(Verdict::fail, Verdict::fail), "fail (as expected)");
  EXPECT_EQ(text(Verdict::invalid, Verdict::invalid), "invalid (as expected)");
  EXPECT_EQ(text(Verdict::pass, Verdict::fail), "pass, but fail expected");
  EXPECT_EQ(text(Verdict::inconclusive, Verdict::fail), "inconclusive, but fail expected");
  EXPECT_EQ(text(Verdict::skipped, Verdict::fail), "skipped");
}

TEST(Verdicts, AnExpectedVerdictThatIsNotOkSaysSo) {
  reports::Test test;
  test.verdict = test.expected = Verdict::fail;
  EXPECT_EQ(verdict_text(test), "fail, yet not ok");
}

TEST(Verdicts, FalseAlarmsAreWholeRuns) {
  Record record = example_record();
  record.suites.resize(1);
  const auto rate = [&](double alpha) {
    record.suites[0].alpha = alpha;
    return false_alarms(record);
  };
  EXPECT_EQ(rate(0.04), "False alarms: at most 4 runs in 100.");
  EXPECT_EQ(rate(0.01), "False alarms: at most 1 run in 100.");
  EXPECT_EQ(rate(0.015), "False alarms: at most 15 runs in 1,000.");
  EXPECT_EQ(rate(0.01 / 3), "False alarms: at most 34 runs in 10,000.");
  EXPECT_EQ(rate(1e-9), "False alarms: at most 1 run in 1,000,000,000.");
  EXPECT_EQ(rate(0.5), "False alarms: at most 50 runs in 100.");
  EXPECT_EQ(rate(1.5), "False alarms: in any run, as the suites' alphas add up to 1 or more.");
  EXPECT_THAT(error_rates(record), testing::HasSubstr("with probability 1 at most"));
  EXPECT_EQ(false_alarms(Record{}), "");
}

TEST(Verdicts, ARunIsSummedUpInWords) {
  EXPECT_EQ(verdict_counts(example_record()),
            "1\u00A0pass, but fail expected; 1\u00A0error; 2\u00A0fail; 1\u00A0invalid; "
            "2\u00A0inconclusive; 1\u00A0skipped; 4\u00A0pass; 1\u00A0fail (as expected)");
  EXPECT_EQ(verdict_counts(Record{}), "");
}

TEST(Verdicts, ATallyAgreesWithItsNumber) {
  EXPECT_EQ(tally_sentence({.failed = 1}), "1 of 1\u00A0claim broken");
  EXPECT_EQ(tally_sentence({.passed = 1}), "The claim is as it should be");
  EXPECT_EQ(tally_sentence({.passed = 3}), "All 3 claims are as they should be");
  EXPECT_EQ(tally_sentence({.passed = 1, .skipped = 2}),
            "1 of 3\u00A0claims as they should be, 2 not tested");
  EXPECT_EQ(tally_sentence({.passed = 1, .inconclusive = 2}),
            "2 of 3\u00A0claims undecided, none broken");
  EXPECT_EQ(tally_sentence({.skipped = 2}), "None of 2 claims was tested");
  EXPECT_EQ(tally_sentence({}), "No claim was tested");
}

TEST(Verdicts, TheErrorRatesOfARunAreThoseOfItsSuitesTogether) {
  Record record;
  record.suites.resize(2);
  for (Suite& suite : record.suites) {
    suite.alpha = 0.01;
    suite.beta = 0.02;
    suite.tests.resize(1);
  }
  EXPECT_EQ(error_rates(record),
            "If every claim were true, some test would fail by chance with probability 0.02 at "
            "most.");
  record.suites[0].tests[0].detect = 0.1;
  EXPECT_NE(error_rates(record).find("off by its \"detect\" or more passes with probability 0.02"),
            std::string::npos);
}

}  // namespace
}  // namespace assay::reports
