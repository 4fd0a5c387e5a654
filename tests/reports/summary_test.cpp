#include "reports/words/display.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

TEST(Verdicts, AnExpectedVerdictThatIsNotOkSaysSo) {
  reports::Test test = judged(Verdict::fail, Verdict::fail);
  test.ok = false;
  EXPECT_EQ(verdict_text(test), "fail, yet not ok");
}

TEST(Verdicts, TheErrorRatesOfARunAreThoseOfItsSuitesTogether) {
  Suite suite{.alpha = 0.01, .beta = 0.02, .tests = {judged(Verdict::pass)}};
  Record record;
  record.suites = {suite, suite};
  EXPECT_EQ(false_alarms(record), "False alarms: at most 2 runs in 100.");
  EXPECT_EQ(error_rates(record),
            "If every claim were true, some test would fail by chance with probability 0.02 at "
            "most.");
  record.suites[0].alpha = 1.5;
  EXPECT_THAT(error_rates(record), HasSubstr("with probability 1 at most"));
  record.suites[0].tests[0].detect = 0.1;
  EXPECT_THAT(error_rates(record),
              HasSubstr("off by its \"detect\" or more passes with probability 0.02"));
  EXPECT_EQ(verdict_counts({}) + false_alarms(Record{}), "");
}

}  // namespace
}  // namespace assay::reports
