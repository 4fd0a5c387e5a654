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
  EXPECT_EQ(error_rates(record), "False alarms: at most 2 runs in 100.");
  record.suites[0].tests[0].detect = 0.1;
  EXPECT_EQ(error_rates(record), false_alarms(record) +
                                     " Misses: at most 2 claims in 100 of those that are wrong by "
                                     "`detect`.");
  record.suites[0].alpha = 1.5;
  EXPECT_THAT(error_rates(record), HasSubstr("False alarms: in any run"));
  EXPECT_EQ(counts_text({}) + false_alarms(Record{}), "");
}

}  // namespace
}  // namespace assay::reports
