#include "reports/formats/junit.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/words/text.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"
#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

Record one_test(const reports::Test& test) {
  Record record;
  record.suites.resize(1);
  record.suites[0].name = "suite";
  record.suites[0].tests = {test};
  return record;
}

TEST(Junit, EachVerdictHasItsElement) {
  reports::Test test;
  test.id = "suite/name";
  const auto written = [&test](Verdict verdict, Verdict expected, bool ok) {
    test.verdict = verdict;
    test.expected = expected;
    test.ok = ok;
    return junit(one_test(test));
  };
  EXPECT_NE(written(Verdict::fail, Verdict::pass, false).find("type=\"fail\""), std::string::npos);
  EXPECT_NE(written(Verdict::invalid, Verdict::pass, false)
                .find("<failure message=\"invalid\" type=\"invalid\""),
            std::string::npos);
  EXPECT_NE(written(Verdict::error, Verdict::pass, false).find("<error "), std::string::npos);
  EXPECT_NE(written(Verdict::pass, Verdict::fail, false).find("pass, but fail expected"),
            std::string::npos);
  EXPECT_NE(written(Verdict::inconclusive, Verdict::pass, false).find("<skipped "),
            std::string::npos);
  const std::string caught = written(Verdict::fail, Verdict::fail, true);
  EXPECT_EQ(caught.find("<failure"), std::string::npos);
  EXPECT_EQ(caught.find("<error"), std::string::npos);
  EXPECT_EQ(caught.find("<skipped"), std::string::npos);
}

TEST(Junit, EqualNamesAreMadeDifferent) {
  reports::Test test;
  test.id = "suite/a";
  Record record = one_test(test);
  record.suites[0].tests = {test, test, test};
  record.suites[0].tests[1].id = "suite/a (2)";
  const std::string xml = junit(record);
  for (const char* name : {"name=\"a\"", "name=\"a (2)\"", "name=\"a (3)\""})
    EXPECT_EQ(occurrences(xml, std::string(" ") + name), 1u) << name << xml;
}

TEST(Junit, LongTextsAreCappedAndSayso) {
  reports::Test test;
  test.id = "suite/a";
  test.verdict = Verdict::fail;
  test.message = std::string(1 << 20, 'm');
  const std::string xml = junit(one_test(test));
  EXPECT_LT(xml.size(), 72u * 1024);
  EXPECT_NE(xml.find("bytes in all, the JSON record has them]"), std::string::npos);
}

TEST(Junit, TimesArePlainDecimals) {
  reports::Test test;
  test.samples.resize(1);
  test.samples[0].cost.seconds = 1.5e-7;
  EXPECT_NE(junit(one_test(test)).find("time=\"0.000000\""), std::string::npos);
}

RC_GTEST_PROP(Junit, HoldsNoControlCharacterAndNoIllFormedText, ()) {
  const std::string xml = junit(random_record());
  RC_ASSERT(clean(xml) == xml);
}

// Alarms of a ledger are cases as well.
int alarms_shown(const Record& record) {
  return record.ledger.file.empty() ? 0 : alarms(record.ledger);
}

RC_GTEST_PROP(Junit, HasOneResultForEveryTestThatIsNotOk, ()) {
  const Record record = random_record();
  const Tally counts = tally(record);
  const std::string xml = junit(record);
  RC_ASSERT(occurrences(xml, "<failure ") + occurrences(xml, "<error ") ==
            static_cast<std::size_t>(counts.failed + alarms_shown(record)));
  RC_ASSERT(occurrences(xml, "<skipped ") ==
            static_cast<std::size_t>(counts.inconclusive + counts.skipped));
}

}  // namespace
}  // namespace assay::reports
