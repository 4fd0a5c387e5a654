#include <fmt/format.h>

#include "reports/formats/ledger.h"
#include "reports/viewer/html_parts.h"
#include "reports/viewer/html_table.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string nights_table(const LedgerSeries& series) {
  const bool estimates = series.estimate.has_value();
  HtmlTable table(
      {{"night"}, {estimates ? "estimate [95 %]" : "p", true}, {"E so far", true}, {"commit"}});
  for (const LedgerNight& night : series.nights) {
    table.row({{escape_xml(night.date)},
               {escape_xml(night_value(series, night))},
               {escape_xml(e_text(night.log_e))},
               {escape_xml(night.commit)}});
  }
  return fmt::format("<details><summary>{}</summary>\n{}</details>", series.nights.size(),
                     table.finish());
}

void add(HtmlTable& table, const Ledger& ledger, const LedgerSeries& series) {
  const std::string name = escape_xml(one_line(series_name(ledger, series)));
  const std::string words = series.alarm ? alarm_sentence(series) : series.note;
  table.row({{series.alarm ? "<span class=\"badge\">✗ alarm</span>"
                           : "<span class=\"badge\">✓ no alarm</span>",
              "verdict"},
             {name, "name"},
             {series.nights.empty() ? "0" : nights_table(series)},
             {escape_xml(e_text(series.log_e()))},
             {escape_xml(e_text(series.limit))},
             {fmt::format("<span>{}{}{}</span>", escape_xml(one_line(series_sentence(series))),
                          words.empty() ? "" : "<br/>", escape_xml(one_line(words)))}},
            series.alarm ? "failed" : "passed");
}

}  // namespace

std::string ledger_section(const Ledger& ledger) {
  if (ledger.file.empty()) return {};
  HtmlTable table({{"ledger"},
                   {"test"},
                   {"nights", true},
                   {"E, their e-value", true},
                   {"E that alarms", true},
                   {"what the nights say together"}},
                  "cards");
  for (const LedgerSeries& series : ledger.series) {
    if (series.alarm) add(table, ledger, series);
  }
  for (const LedgerSeries& series : ledger.series) {
    if (!series.alarm) add(table, ledger, series);
  }
  return fmt::format(
      "<h2 id=\"ledger\">{}</h2>\n<p class=\"muted\">{}</p>\n{}",
      escape_xml(one_line(ledger_title(ledger))),
      "The e-value E of all nights together is the evidence against a claim: while the claim is "
      "true, the probability that E ever reaches a number A, on any night, is 1 / A at most.",
      table.finish());
}

}  // namespace assay::reports
