#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/run/suite_run.h"
#include "harness/suite/run_options.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Adds a note on the programs that were started again.
void note_retries(reports::Record& record);

/// The note of a record without some tests of its suites.
inline constexpr const char* partial_note =
    "not every test of the suites ran: their p-values are not adjusted by Holm's method, which "
    "takes all";

reports::Record record_of(const std::vector<std::unique_ptr<SuiteRun>>& runs,
                          const RunOptions& options);

reports::Test record_of_test(const TestWork& work, const std::string& file, bool adjusted);

}  // namespace assay::harness
