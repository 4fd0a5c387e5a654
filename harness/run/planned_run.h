#pragma once

// The common part of `run` and `plan`: suites prepared, piloted and planned, nothing sampled.

#include <memory>
#include <vector>

#include "estimators/rendered.h"
#include "harness/run/pools.h"
#include "harness/run/suite_run.h"
#include "harness/sampling/executor.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

struct PlannedRun {
  std::vector<std::unique_ptr<SuiteRun>> suites;
  Pools pools;  ///< For the selected tests and the suites' pictures; nothing is drawn.
};

/// Set-ups of all estimators and of all sides of claims.
NamedSetups setups_of(const PlannedRun& run);

/// Prepares all suites; nothing is drawn. InputError for any mistake.
PlannedRun prepare_run(const std::vector<Suite>& suites, const RunOptions& options);

/// Prepares all suites, then draws the pilots of the selected tests and freezes their plans.
/// InputError for any mistake, before the first pilot.
PlannedRun plan_run(const std::vector<Suite>& suites, const RunOptions& options,
                    Progress& progress);

/// The files that programs would render for a run and that are not there. Those of the pilots come
/// first. Once they are there, the files that the tests take at most follow. A program starts only
/// to tell the size of its pictures.
std::vector<foreign::MissingFile> missing_files(const std::vector<Suite>& suites,
                                                const RunOptions& options, Progress& progress);

}  // namespace assay::harness
