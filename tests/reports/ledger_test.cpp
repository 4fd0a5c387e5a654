#include "reports/words/ledger.h"

#include "reports/formats/console.h"
#include "reports/formats/json.h"
#include "reports/formats/junit.h"
#include "reports/formats/markdown.h"
#include "reports/formats/read_json.h"
#include "reports/words/number.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

Record without_alarm() {
  Record record = example_record();
  record.ledger.series.erase(record.ledger.series.begin());
  return record;
}

TEST(LedgerText, SaysWhatTheNightsSayTogether) {
  LedgerSeries series = example_record().ledger.series[0];
  EXPECT_EQ(series_sentence(series),
            "12 nights since 2026-11-09: relative difference from the reference +0.1 %, standard "
            "error 0.0253 % of the nights and 0.01 % of the reference, e-value E = 13360, "
            "alarm at 665");
  EXPECT_EQ(alarm_sentence(series),
            "the nights together refute the claim since 2026-11-18T02:00:00Z; it moved most likely "
            "on the night of 2026-11-13T02:00:00Z, commit 14467a0bbe61 (90 %: 2026-11-11T02:00:00Z "
            "to 2026-11-15T02:00:00Z)");
  EXPECT_EQ(series_sentence(example_record().ledger.series[2]), "no night yet");
  series.reference_error = 0.;
  EXPECT_NE(series_sentence(series).find("standard error 0.0253 %, e-value E"), std::string::npos);
}

TEST(LedgerText, NamesTheChannelWhereThereAreSeveral) {
  const Ledger ledger = example_record().ledger;
  EXPECT_EQ(series_name(ledger, ledger.series[0]), "triangle/mean(area) == analytic [irradiance]");
  EXPECT_EQ(series_name(ledger, ledger.series[2]), "triangle/a law");
}

TEST(LedgerText, WritesEValuesOfAnySize) {
  EXPECT_EQ(e_text(0.0), "1");
  EXPECT_EQ(e_text(std::log(2003.4)), "2003");
  EXPECT_EQ(e_text(std::log(31.66)), "31.7");
  EXPECT_EQ(e_text(5000.0), "3.0e2171");
  EXPECT_EQ(e_text(-5000.0), "3.4e-2172");
  EXPECT_EQ(e_text(Number()), no_number);
}

TEST(LedgerText, OneNoteStandsForAllSeriesThatShareIt) {
  Ledger ledger;
  ledger.series = {{.test = "a", .note = "same"}, {.test = "b", .note = "same"}, {.test = "c"}};
  EXPECT_THAT(ledger_notes(ledger), testing::ElementsAre("a and 1 more: same"));
}

TEST(LedgerReports, EveryFormatShowsAnAlarm) {
  const Record record = example_record();
  EXPECT_THAT(console(record, {.detail = 2}),
              HasSubstr("ALARM triangle/mean(area) == analytic [irradiance]"));
  EXPECT_THAT(console(record), HasSubstr("broken; 1 ledger alarm"));
  EXPECT_THAT(markdown(record), HasSubstr("; 1 ledger alarm\n"));
  EXPECT_THAT(markdown(record), HasSubstr("**alarm**"));
  EXPECT_THAT(junit(record), HasSubstr("type=\"alarm\""));
}

TEST(LedgerReports, NoFormatShowsAnAlarmWhereThereIsNone) {
  const Record record = without_alarm();
  for (const std::string& text :
       {console(record, {.detail = 2}), markdown(record), junit(record)}) {
    EXPECT_THAT(text, HasSubstr("Ledger nightly.ledger"));
    EXPECT_THAT(text, Not(HasSubstr("1 ledger alarm")));
    EXPECT_THAT(text, Not(HasSubstr("type=\"alarm\"")));
  }
}

TEST(LedgerReports, NothingIsSaidWhereNoLedgerIsKept) {
  Record record = example_record();
  record.ledger = {};
  for (const std::string& text :
       {console(record, {.detail = 2}), markdown(record), junit(record)}) {
    EXPECT_THAT(text, Not(HasSubstr("Ledger")));
  }
}

TEST(LedgerReports, JsonReadsBack) {
  const Record record = example_record();
  EXPECT_EQ(read_json(json(record), "run.json").ledger, record.ledger);
}

}  // namespace
}  // namespace assay::reports
