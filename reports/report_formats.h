#pragma once

// The table of reports that a record can be shown as.

#include <string>
#include <vector>

#include "reports/formats/console.h"
#include "reports/record/calibration.h"
#include "reports/record/record.h"

namespace assay::reports {

/// A new kind of report is a row and a file.
struct ReportFormat {
  std::string kind;    ///< as in `--report KIND=PATH`
  std::string ending;  ///< of a file that is meant to be one
  std::string summary;
  std::string (*of_record)(const Record&, const ConsoleOptions&);
  std::string (*of_calibration)(const Calibration&) = nullptr;  ///< null where there is none
};

const std::vector<ReportFormat>& report_formats();

/// std::out_of_range where there is none.
const ReportFormat& report_format(const std::string& kind);

}  // namespace assay::reports
