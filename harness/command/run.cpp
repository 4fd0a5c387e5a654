#include "harness/command/run.h"

#include <fmt/format.h>

#include <chrono>

#include "harness/base/interrupt.h"
#include "harness/base/parallel.h"
#include "harness/ledger/ledger.h"
#include "harness/record/environment.h"
#include "harness/record/record_of.h"
#include "harness/run/holm.h"
#include "harness/run/looks.h"
#include "harness/run/planned_run.h"

namespace assay::harness {
namespace {

/// A family without some of its tests has no adjusted p-values.
void adjust_if_whole(SuiteRun& run, const RunOptions& options) {
  run.adjusted = run.tests.size() + run.untested.size() == run.suite.tests.size() && !options.shard;
  if (run.adjusted) adjust_p_values(run.tests);
}

void add_note(reports::Record& record, const std::string& note) {
  record.note += (record.note.empty() ? "" : "; ") + note;
}

/// Adds remarks on the ledger.
void note_ledger(reports::Record& record, const std::vector<std::unique_ptr<SuiteRun>>& runs,
                 const RunOptions& options) {
  std::size_t outside = 0;
  for (const auto& run : runs) {
    for (const TestWork& work : run->tests) outside += work.outcome.place.inside ? 0 : 1;
  }
  if (outside > 0) {
    add_note(record, fmt::format("{} of the tests {} outside the ledger: mutants and expected "
                                 "failures",
                                 outside, outside == 1 ? "stands" : "stand"));
  }
  if (!options.seed) {
    add_note(record,
             "no seed was given: a night with the suite's own seed is the same every time and "
             "counts once; run nights with --seed random");
  }
}

reports::Record run_in_arena(const std::vector<Suite>& suites, const RunOptions& options,
                             Progress& progress, std::string* ledger_fault) {
  const auto start = std::chrono::steady_clock::now();
  const std::string started = utc_now();
  if (!options.ledger.empty()) require_ledger(options.ledger, suites);
  if (!options.ledger.empty() && options.shard) {
    throw InputError({},
                     "--ledger takes whole runs: leave --shard and the environment's shards out");
  }
  const PlannedRun planned = plan_run(suites, options, progress);
  std::vector<TestWork*> tests;
  for (auto& run : planned.suites) {
    for (TestWork& work : run->tests) tests.push_back(&work);
  }
  sample_in_looks(tests, planned.pools.all(), options.threads, progress);
  stop_if_interrupted();
  for (auto& run : planned.suites) adjust_if_whole(*run, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  reports::Record record = record_of(planned.suites, options);
  record.started = started;
  record.seconds = elapsed.count();
  if (options.ledger.empty()) return record;
  try {
    record.ledger = add_to_ledger({options.ledger, started, record.tool.commit}, planned.suites);
    note_ledger(record, planned.suites, options);
  } catch (const std::runtime_error& error) {
    if (ledger_fault == nullptr) throw;
    *ledger_fault = error.what();
    add_note(record, fmt::format("nothing was added to the ledger: {}", error.what()));
  }
  return record;
}

}  // namespace

reports::Record run(const std::vector<Suite>& suites, const RunOptions& options, Progress& progress,
                    std::string* ledger_fault) {
  return with_threads(options.threads,
                      [&] { return run_in_arena(suites, options, progress, ledger_fault); });
}

}  // namespace assay::harness
