#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/run/suite_run.h"
#include "harness/suite/run_options.h"
#include "reports/record/record.h"

namespace assay::harness {

/// The note of a record without some tests of its suites.
inline constexpr const char* partial_note =
    "not every test of the suites ran: verdicts rest on each test's fixed share of alpha, without "
    "Holm's adjustment";

reports::Record record_of(const std::vector<std::unique_ptr<SuiteRun>>& runs,
                          const RunOptions& options);

reports::Test record_of_test(const TestWork& work, const std::string& file, bool holm);

}  // namespace assay::harness
