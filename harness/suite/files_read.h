#pragma once

// What a command reads or keeps, so that no report is written over it.

#include <string>
#include <vector>

#include "harness/suite/suite.h"

namespace assay::harness {

/// The suites' own files and the files, relative to their suite, that a parameter of an estimator
/// names: recorded rows, programs, libraries.
std::vector<std::string> files_read(const std::vector<Suite>& suites);

/// InputError where the report would be written over one of `kept`, by whichever path.
void refuse_overwriting(const std::string& report, const std::vector<std::string>& kept);

}  // namespace assay::harness
