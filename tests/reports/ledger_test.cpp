#include "reports/words/ledger.h"

#include "reports/report_formats.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

TEST(LedgerText, AnExactReferenceHasNoErrorToName) {
  LedgerSeries series = example_record().ledger.series[0];
  series.reference_error = 0.;
  EXPECT_THAT(series_sentence(series), HasSubstr("standard error 0.0253\u00A0%, e-value E"));
}

TEST(LedgerText, AMoveThatNeedNotHaveHappenedIsNotNamed) {
  LedgerSeries series = example_record().ledger.series[0];
  series.moved_from = series.nights.front().date;
  EXPECT_THAT(
      alarm_sentence(series),
      HasSubstr("is +0.1\u00A0% (95\u00A0% interval: +0.0467\u00A0% to +0.153\u00A0%). It may "
                "have been so from the first night on (90\u00A0% sure: 2026-11-09 02:00 to"));
  EXPECT_EQ(changes(series), "");
}

TEST(LedgerText, OneNoteStandsForAllSeriesThatShareIt) {
  Ledger ledger;
  ledger.series = {{.test = "a", .note = "same"}, {.test = "b", .note = "same"}, {.test = "c"}};
  EXPECT_THAT(ledger_notes(ledger), testing::ElementsAre("a and 1 more: same"));
}

TEST(LedgerReports, NoFormatShowsAnAlarmOrALedgerWhereThereIsNone) {
  Record record = example_record();
  record.ledger.series.erase(record.ledger.series.begin());
  Record bare = record;
  bare.ledger = {};
  for (const auto& write : {+[](const Record& r) { return console(r, {.detail = 2}); },
                            +[](const Record& r) { return markdown(r); }, junit}) {
    EXPECT_THAT(write(record), HasSubstr("Ledger nightly.ledger"));
    EXPECT_THAT(write(record), Not(ContainsRegex("1 ledger alarm|type=\"alarm\"")));
    EXPECT_THAT(write(bare), Not(HasSubstr("Ledger")));
  }
}

}  // namespace
}  // namespace assay::reports
