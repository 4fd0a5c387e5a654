#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

struct ConsoleOptions {
  bool colour = false;   ///< with ANSI escape sequences
  int width = 100;       ///< columns that no line exceeds; below 60 counts as 60
  bool verbose = false;  ///< explain every test and list the estimators, not only what is not ok
};

/// The record for a terminal. The last line is exactly "N passed, N failed, N skipped";
/// inconclusive tests count as skipped there and are named on the line before.
std::string console(const Record&, ConsoleOptions = {});

}  // namespace assay::reports
