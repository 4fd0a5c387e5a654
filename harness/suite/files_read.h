#pragma once

// Protects files that a command reads from being overwritten by a report.

#include <string>
#include <vector>

#include "harness/suite/suite.h"

namespace assay::harness {

/// The suites' own files, and every file that an estimator's parameter names, relative to its
/// suite: recorded rows, programs, libraries.
std::vector<std::string> files_read(const std::vector<Suite>& suites);

/// InputError if the report would replace one of `kept`, by whichever path.
void refuse_overwriting(const std::string& report, const std::vector<std::string>& kept);

}  // namespace assay::harness
