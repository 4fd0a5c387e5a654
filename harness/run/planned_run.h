#pragma once

// The suites of a run, and the common part of `run` and `plan`: suites are prepared, piloted and
// planned, and nothing is sampled.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "estimators/rendered.h"
#include "harness/base/work.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/question/question.h"
#include "harness/run/evaluate.h"
#include "harness/sampling/executor.h"
#include "harness/sampling/pool.h"
#include "harness/sampling/prepare.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

/// Stored values of every channel, for the normal quantile plot.
inline constexpr std::uint64_t plotted_values = 2000;

/// Plugin, parameters, folder, purpose, stream and primaries: equal ones draw the same.
using PoolIdentity =
    std::tuple<std::string, std::string, std::string, std::string, std::uint64_t, std::uint64_t>;
PoolIdentity pool_identity(const Subject& side, std::uint64_t primaries, std::uint64_t seed);

/// All pools of a run. Tests that draw the same stream from the same plugin share one.
class Pools {
 public:
  /// The pools of a test, one for each subject, planned for what the method keeps.
  std::vector<std::shared_ptr<Pool>> for_question(const Question& question, const Plan& plan,
                                                  std::uint64_t seed, const Pilots& pilots);

  const std::vector<std::shared_ptr<Pool>>& all() const { return all_; }

 private:
  /// The pool of a subject, without plans for a test.
  std::shared_ptr<Pool> find_or_make(const Subject& side, std::uint64_t primaries,
                                     std::uint64_t seed, const Pilots& pilots);

  std::map<PoolIdentity, std::shared_ptr<Pool>> pools_;
  std::vector<std::shared_ptr<Pool>> all_;
};

struct Rounds {
  std::shared_ptr<Executor> executor = threads();
  bool cheapest_first = false;  ///< A round takes one look, that with the fewest primaries.
  /// Hears of each test when it is decided. If it answers no, nothing more is drawn.
  std::function<bool(const TestWork&)> decided = {};
};

/// Draws in rounds: in each, every undecided test takes its next look. It ends when every test is
/// decided or has taken its last look. A test's data depend on its own plan alone. Stops early when
/// the user interrupts or `decided` says no; tests are then left undecided.
void sample_in_looks(const std::vector<TestWork*>& tests,
                     const std::vector<std::shared_ptr<Pool>>& pools, const Rounds& rounds,
                     Progress& progress);

/// A test without a question. It is skipped if a program that its suite needs is missing, and an
/// error if a source cannot be prepared.
struct Untested {
  const TestEntry* test;
  reports::Verdict verdict;
  std::string message;
};

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

// ---- Claims on two stacks of pictures that are never held as a whole. Rows are read once; the
// pilot and the test take what they need of them before the next rows. Other pictures are kept, and
// must fit into memory.

/// Claims that can be answered row by row. Each must be its estimators' only one, and ask whether
/// equally many pictures, all of each side, are equal.
using StreamedClaims = std::vector<const Question*>;
StreamedClaims streamed(const std::vector<Question>& questions);

struct StreamedPictures {
  /// The pilots with the look at their pictures, or the fault of an unreadable source, or none.
  Pilots pilots = {};
  /// Why there are no pilots: the numbers need whole pictures. "" if the user interrupted.
  std::string fault = {};
};

StreamedPictures stream_pictures(const Question& question, Progress& progress);

/// Peak bytes of testing the picture files of all these estimators.
double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators,
                     const StreamedClaims& streamed);

/// Bytes that this process may still take, by the system or its control group. Infinity if unknown.
double available_bytes();

/// InputError at the estimator with most pictures if they need more than `available`. The message
/// begins with `fault`, if any: why they cannot be read row by row.
void require_memory(const std::map<std::string, PreparedEstimator>& estimators,
                    const StreamedClaims& streamed, double available,
                    const std::string& fault = "");

}  // namespace assay::harness
