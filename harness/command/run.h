#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/base/progress.h"
#include "harness/suite/run_options.h"
#include "harness/suite/suite.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Hears of a broken claim when it is decided.
using Broken = std::function<void(const reports::Test&)>;

/// Runs the selected tests of the suites. InputError for any mistake found before sampling. A
/// ledger that cannot be written is a std::runtime_error, or goes to `ledger_fault`.
reports::Record run(const std::vector<Suite>& suites, const RunOptions& options, Progress& progress,
                    const Broken& broken = {}, std::string* ledger_fault = nullptr);

}  // namespace assay::harness
