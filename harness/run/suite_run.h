#pragma once

// A suite in a run, from what it says to what came out.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/question/pilot.h"
#include "harness/run/evaluate.h"

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

}  // namespace assay::harness
