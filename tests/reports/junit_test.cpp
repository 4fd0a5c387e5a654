#include "reports/report_formats.h"
#include "reports/words/text.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(Junit, EachVerdictHasItsElement) {
  const auto written = [](Verdict verdict, Verdict expected = Verdict::pass) {
    return junit(record_of({judged(verdict, expected)}));
  };
  EXPECT_THAT(written(Verdict::fail), HasSubstr("type=\"fail\""));
  EXPECT_THAT(written(Verdict::invalid),
              HasSubstr("<failure message=\"invalid\" type=\"invalid\""));
  EXPECT_THAT(written(Verdict::error), HasSubstr("<error "));
  EXPECT_THAT(written(Verdict::pass, Verdict::fail), HasSubstr("pass, but fail expected"));
  EXPECT_THAT(written(Verdict::inconclusive), HasSubstr("<skipped "));
  EXPECT_THAT(written(Verdict::fail, Verdict::fail),
              Not(ContainsRegex("<(failure|error|skipped)")));
}

TEST(Junit, EqualNamesAreMadeDifferent) {
  const reports::Test test = judged(Verdict::pass);
  Record record = record_of({test, test, test});
  record.suites[0].tests[1].id = "suite/name (2)";
  const std::string xml = junit(record);
  for (const char* name : {"name=\"name\"", "name=\"name (2)\"", "name=\"name (3)\""})
    EXPECT_EQ(occurrences(xml, std::string(" ") + name), 1u) << name << xml;
}

TEST(Junit, LongTextsAreCappedAndSayso) {
  reports::Test test = judged(Verdict::fail);
  test.message = std::string(1 << 20, 'm');
  const std::string xml = junit(record_of({test}));
  EXPECT_LT(xml.size(), 72u * 1024);
  EXPECT_THAT(xml, HasSubstr("bytes in all, the JSON record has them]"));
}

TEST(Junit, TimesArePlainDecimals) {
  reports::Test test;
  test.samples.resize(1);
  test.samples[0].cost.seconds = 1.5e-7;
  EXPECT_THAT(junit(record_of({test})), HasSubstr("time=\"0.000000\""));
}

RC_GTEST_PROP(Junit, HoldsNoControlCharacterAndNoIllFormedText, ()) {
  const std::string xml = junit(random_record());
  RC_ASSERT(clean(xml) == xml);
}

RC_GTEST_PROP(Junit, HasOneResultForEveryTestThatIsNotOk, ()) {
  const Record record = random_record();
  Standings counts = standings(record);
  const std::string xml = junit(record);
  // Alarms of a ledger are cases as well.
  if (!record.ledger.file.empty()) counts[Standing::broken] += alarms(record.ledger);
  RC_ASSERT(occurrences(xml, "<failure ") + occurrences(xml, "<error ") ==
            static_cast<std::size_t>(counts[Standing::broken] + counts[Standing::no_verdict]));
  RC_ASSERT(occurrences(xml, "<skipped ") ==
            static_cast<std::size_t>(counts[Standing::undecided] + counts[Standing::not_run]));
}

}  // namespace
}  // namespace assay::reports
