#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

struct ConsoleOptions {
  bool colour = false;   ///< ANSI escape sequences.
  int width = 100;       ///< Columns of a line at most; below 60 counts as 60.
  bool verbose = false;  ///< Explains every test, and lists the estimators.
};

/// The record for a terminal. The last line is exactly "N passed, N failed, N skipped";
/// inconclusive tests count as skipped there and are named on the line before.
std::string console(const Record&, ConsoleOptions = {});

}  // namespace assay::reports
