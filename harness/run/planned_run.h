#pragma once

// The suites of a run, and the common part of `run` and `plan`: suites are prepared, piloted and
// planned, and nothing is sampled.

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "estimators/rendered.h"
#include "harness/pilot/pilot.h"
#include "harness/run/evaluate.h"
#include "harness/run/looks.h"
#include "harness/sampling/executor.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

/// A test without a question. It is skipped if a program that its suite needs is missing, and an
/// error if a source cannot be prepared.
struct Untested {
  const TestEntry* test;
  reports::Verdict verdict;
  std::string message;
};

/// A suite in a run: its text, what was prepared from it, and its results.
struct SuiteRun {
  Suite suite;
  std::uint64_t seed = 1;
  std::map<std::string, PreparedEstimator> estimators;
  std::vector<Question> questions = {};  ///< Questions of its tests that have no plan yet.
  std::vector<const PreparedEstimator*> used = {};  ///< Of the selected tests, in the file's order.
  Pilots pilots = {};                               ///< Pilots of the selected tests' estimators.
  std::vector<TestWork> tests = {};                 ///< The selected tests, in a shard its own.
  std::vector<Untested> untested = {};              ///< Those of them without a question.
  std::vector<reports::ShardElsewhere> elsewhere = {};  ///< Those of other shards.
  bool adjusted = false;  ///< True if the whole family ran, so that its p-values are adjusted.
};

using SuiteRuns = std::vector<std::unique_ptr<SuiteRun>>;

struct PlannedRun {
  SuiteRuns suites;
  Pools pools;  ///< For the selected tests; nothing is drawn.
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
