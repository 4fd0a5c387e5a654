#pragma once

// From results to the record.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/evaluate.h"
#include "harness/pilot.h"
#include "harness/run.h"
#include "reports/record.h"

namespace assay::harness {

/// An estimator with the pool its picture is drawn from.
struct Picture {
  const PreparedEstimator* estimator;
  std::shared_ptr<Pool> pool;
  /// Observations drawn for the picture alone; nullopt: it shows those of the suite's tests.
  std::optional<std::uint64_t> own = {};
};

/// A test that no question can be made of: it is skipped where a program is missing that its suite
/// needs, and an error where one of its sources cannot be prepared.
struct Untested {
  const TestEntry* test;
  reports::Verdict verdict;
  std::string message;
};

/// A suite in a run: what it says, what was prepared from it, what came out.
struct SuiteRun {
  Suite suite;
  std::uint64_t seed = 1;
  std::map<std::string, PreparedEstimator> estimators;
  std::vector<Question> questions = {};  ///< of its tests, but for those that cannot be tested
  Pilots pilots = {};                    ///< of the estimators of the selected tests
  std::vector<TestWork> tests = {};      ///< the selected ones
  std::vector<Untested> untested = {};   ///< of the selected ones the others
  std::vector<Picture> pictures = {};
  bool holm = false;  ///< the whole family ran
};

/// The number of observations that a picture shows: those of the test that drew most of them. It is
/// the same whatever else ran, but for the suite's other tests.
std::uint64_t shown_by(const Picture& picture, const SuiteRun& run);

/// What a record says that holds not all tests of its suites.
inline constexpr const char* partial_note =
    "not every test of the suites ran: verdicts rest on each test's fixed share of alpha, without "
    "Holm's adjustment";

reports::Record record_of(const std::vector<std::unique_ptr<SuiteRun>>& runs,
                          const RunOptions& options);

/// One test's numbers and verdict.
reports::Test record_of_test(const TestWork& work, const std::string& file, bool holm);

/// The probability of a natural logarithm; the least double stands for what underflows.
reports::Number probability(double log_p);
reports::Number log10_of(double log_p);

reports::Tool this_tool();
reports::Environment this_environment(unsigned threads);
/// The time now as "2000-01-01T00:00:00Z".
std::string utc_now();

}  // namespace assay::harness
