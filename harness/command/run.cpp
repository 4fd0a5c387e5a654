#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "estimators/core/waiting.h"
#include "harness/base/interrupt.h"
#include "harness/base/parallel.h"
#include "harness/command/commands.h"
#include "harness/ledger/ledger.h"
#include "harness/plan/plan.h"
#include "harness/record/record_of.h"
#include "harness/run/evaluate.h"
#include "harness/run/looks.h"
#include "harness/run/planned_run.h"

namespace assay::harness {
namespace {

/// Tells of the first doubtful margin. A single test tells it with its verdict.
void note_margins(const PlannedRun& planned) {
  std::vector<std::string> doubts;
  std::size_t tests = 0;
  for (const auto& run : planned.suites) {
    tests += run->tests.size();
    for (const TestWork& work : run->tests) {
      const std::string doubt = doubtful_margin(work.outcome.question, run->pilots);
      if (doubt.empty()) continue;
      doubts.push_back(fmt::format("`{}`: {}", work.outcome.question.test->id, doubt));
    }
  }
  if (doubts.empty() || tests == 1) return;
  const std::size_t others = doubts.size() - 1;
  notice(doubts[0] + (others > 0 ? fmt::format(" ({} other doubtful `detect`)", others) : ""));
}

/// Adds remarks on the ledger.
void note_ledger(reports::Record& record, const SuiteRuns& runs, const RunOptions& options) {
  std::size_t outside = 0;
  for (const auto& run : runs) {
    for (const TestWork& work : run->tests) outside += work.outcome.place.inside ? 0 : 1;
  }
  if (outside > 0) {
    add_note(record, fmt::format("{} test{} outside the ledger: mutants and expected failures",
                                 outside, outside == 1 ? " is" : "s are"));
  }
  if (!options.seed) {
    add_note(record,
             "no --seed was given: nights with the suite's own seed are all the same and count "
             "once; run nights with --seed random");
  }
}

/// Tells of broken claims, and whether to draw on.
class Listener {
 public:
  Listener(const PlannedRun& planned, const RunOptions& options, const Broken& broken)
      : planned_(planned), options_(options), broken_(broken) {}

  bool hear(const TestWork& work) {
    for (const auto& run : planned_.suites) {
      const bool its =
          std::ranges::any_of(run->tests, [&](const TestWork& x) { return &x == &work; });
      if (!its || !is_broken(work)) continue;
      tell(*run, record_of_test(work, run->suite.file), *work.outcome.question.test);
    }
    return may_go_on();
  }
  bool hear_untested() {
    for (const auto& run : planned_.suites) {
      for (const Untested& each : run->untested) {
        const reports::Test test = record_of_untested(each, *run);
        if (reports::is_failed(reports::standing(test))) tell(*run, test, *each.test);
      }
    }
    return may_go_on();
  }
  bool may_go_on() const { return !options_.fail_fast || first_.empty(); }
  const std::string& first() const { return first_; }  ///< Id of the first broken claim, or "".

 private:
  void tell(const SuiteRun& run, reports::Test test, const TestEntry& entry) {
    if (first_.empty()) first_ = test.id;
    add_replay(entry, run, planned_.suites, options_, test);
    if (broken_) broken_(test);
  }

  const PlannedRun& planned_;
  const RunOptions& options_;
  const Broken& broken_;
  std::string first_ = "";
};

/// Leaves out the tests that were not decided.
void leave_out(SuiteRun& run, const std::string& why) {
  for (const TestWork& work : run.tests) {
    if (work.outcome.decided) continue;
    run.untested.push_back({work.outcome.question.test, reports::Verdict::skipped, why});
  }
  std::ranges::sort(run.untested, {}, &Untested::test);
  std::erase_if(run.tests, [](const TestWork& work) { return !work.outcome.decided; });
}

reports::Record run_in_arena(const std::vector<Suite>& suites, const RunOptions& options,
                             Progress& progress, const Broken& broken, std::string* ledger_fault) {
  const auto start = std::chrono::steady_clock::now();
  const std::string started = utc_now();
  if (!options.ledger.empty()) require_ledger(options.ledger);
  if (!options.ledger.empty() && options.shard) {
    refuse({}, "--ledger needs whole runs: leave out --shard and the environment's shards");
  }
  if (options.fail_fast && (!options.ledger.empty() || options.shard)) {
    refuse({}, "--fail-fast ends a run early: leave --ledger and --shard out");
  }
  const PlannedRun planned = plan_run(suites, options, progress);
  stop_if_interrupted();
  note_margins(planned);
  std::vector<TestWork*> tests;
  for (auto& run : planned.suites) {
    run->pilots.drop_drawn();
    for (TestWork& work : run->tests) tests.push_back(&work);
  }
  Listener listener(planned, options, broken);
  if (listener.hear_untested()) {
    sample_in_looks(tests, planned.pools.all(),
                    {.executor = executor_of(options),
                     .cheapest_first = options.fail_fast,
                     .decided = [&](const TestWork& work) { return listener.hear(work); }},
                    progress);
  }
  const bool none =
      std::ranges::none_of(tests, [](const TestWork* x) { return x->outcome.decided; });
  if (none || !options.ledger.empty() || options.shard) stop_if_interrupted();
  for (auto& run : planned.suites) {
    // A family without some of its tests has no adjusted p-values.
    const bool all = run->tests.size() + run->untested.size() == run->suite.tests.size();
    run->adjusted =
        all && !options.shard &&
        std::ranges::all_of(run->tests, [](const TestWork& work) { return work.outcome.decided; });
    if (interrupted())
      leave_out(*run, "the run was interrupted before its verdict");
    else if (!listener.may_go_on())
      leave_out(*run, fmt::format("the run ended early: `{}` is broken", listener.first()));
  }
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
    add_note(record, fmt::format("the ledger got no evidence: {}", error.what()));
  }
  return record;
}

}  // namespace

reports::Record run(const std::vector<Suite>& suites, const RunOptions& options, Progress& progress,
                    const Broken& broken, std::string* ledger_fault) {
  reports::Record record;
  with_threads(options.threads,
               [&] { record = run_in_arena(suites, options, progress, broken, ledger_fault); });
  return record;
}

}  // namespace assay::harness
