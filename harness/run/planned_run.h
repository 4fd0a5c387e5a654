#pragma once

// What `run` and `plan` have in common: suites prepared, piloted and planned, nothing sampled.

#include <memory>
#include <vector>

#include "harness/run/pools.h"
#include "harness/run/suite_run.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

struct PlannedRun {
  std::vector<std::unique_ptr<SuiteRun>> suites;
  Pools pools;  ///< of the selected tests and the suites' pictures; nothing is drawn
};

/// Prepares all suites, then runs the pilots of the selected tests and freezes their plans.
/// InputError for anything found wrong, before the first pilot.
PlannedRun plan_run(const std::vector<Suite>& suites, const RunOptions& options,
                    Progress& progress);

}  // namespace assay::harness
