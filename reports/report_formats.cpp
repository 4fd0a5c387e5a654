#include "reports/report_formats.h"

#include <algorithm>

namespace assay::reports {

const std::vector<ReportFormat>& report_formats() {
  static const std::vector<ReportFormat> table{
      {"console", "log", "a summary for a terminal",
       [](const Record& record, const ConsoleOptions& options) { return console(record, options); },
       console},
      {"json", "json", "the whole record, for `assay report`, `replay`, `merge` and other programs",
       [](const Record& record, const ConsoleOptions&) { return json(record); }, json},
      {"junit", "xml", "for continuous integration",
       [](const Record& record, const ConsoleOptions&) { return junit(record); }},
      {"markdown", "md", "a summary for a page of a repository",
       [](const Record& record, const ConsoleOptions&) { return markdown(record); }, markdown},
      {"html", "html", "one page with all numbers and pictures",
       [](const Record& record, const ConsoleOptions&) { return html(record); }, html},
      {"metrics", "txt", "OpenMetrics, for dashboards",
       [](const Record& record, const ConsoleOptions&) { return metrics(record); }}};
  return table;
}

const ReportFormat& report_format(const std::string& kind) {
  const auto found = std::ranges::find(report_formats(), kind, &ReportFormat::kind);
  if (found == report_formats().end()) throw std::out_of_range("no report of kind " + kind);
  return *found;
}

}  // namespace assay::reports
