#include "reports/report_formats.h"

#include <algorithm>
#include <stdexcept>

#include "reports/formats/console.h"
#include "reports/formats/json.h"
#include "reports/formats/junit.h"
#include "reports/formats/markdown.h"
#include "reports/formats/metrics.h"
#include "reports/viewer/html.h"

namespace assay::reports {
namespace {

/// One test alone, as of `check`, is shown in full.
bool is_single(const Record& record) {
  return record.suites.size() == 1 && record.suites[0].tests.size() == 1;
}

}  // namespace

const std::vector<ReportFormat>& report_formats() {
  static const std::vector<ReportFormat> table{
      {"console", "log", "a summary for a terminal",
       [](const Record& record, bool colour) {
         return console(record, {.colour = colour, .verbose = is_single(record)});
       },
       [](const Calibration& calibration) { return console(calibration); }},
      {"json", "json", "the whole record, for `assay report`, `replay`, `merge` and other programs",
       [](const Record& record, bool) { return json(record); },
       [](const Calibration& calibration) { return json(calibration); }},
      {"junit", "xml", "for continuous integration",
       [](const Record& record, bool) { return junit(record); }},
      {"markdown", "md", "a summary for a page of a repository",
       [](const Record& record, bool) { return markdown(record); },
       [](const Calibration& calibration) { return markdown(calibration); }},
      {"html", "html", "one page with all numbers and pictures",
       [](const Record& record, bool) { return html(record); },
       [](const Calibration& calibration) { return html(calibration); }},
      {"metrics", "txt", "OpenMetrics, for dashboards",
       [](const Record& record, bool) { return metrics(record); }}};
  return table;
}

const ReportFormat& report_format(const std::string& kind) {
  const auto found = std::ranges::find(report_formats(), kind, &ReportFormat::kind);
  if (found == report_formats().end()) throw std::out_of_range("no report of kind " + kind);
  return *found;
}

}  // namespace assay::reports
