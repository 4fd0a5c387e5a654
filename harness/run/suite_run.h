#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

struct Picture {
  const PreparedEstimator* estimator;
  std::shared_ptr<Pool> pool;
  /// Observations drawn for the picture alone; nullopt: it shows those of the suite's tests.
  std::optional<std::uint64_t> own = {};
};

/// A test without a question. It is skipped if a program that its suite needs is missing, and an
/// error if a source cannot be prepared.
struct Untested {
  const TestEntry* test;
  reports::Verdict verdict;
  std::string message;
};

/// A selected test that another shard of the run takes.
struct Elsewhere {
  const TestEntry* test;
  std::uint64_t shard;  ///< from 1
};

/// A suite in a run: its text, what was prepared from it, and its results.
struct SuiteRun {
  Suite suite;
  std::uint64_t seed = 1;
  std::map<std::string, PreparedEstimator> estimators;
  std::vector<Question> questions = {};  ///< Questions of its tests, without untested ones.
  Pilots pilots = {};                    ///< Pilots of the selected tests' estimators.
  std::vector<TestWork> tests = {};      ///< The selected tests, in a shard its own.
  std::vector<Untested> untested = {};   ///< Those of them without a question.
  std::vector<Elsewhere> elsewhere = {};
  std::vector<Picture> pictures = {};
  bool adjusted = false;  ///< True if the whole family ran, so that its p-values are adjusted.
};

/// The number of observations that a picture shows: those of the test that drew most. It depends on
/// the suite's tests alone.
std::uint64_t shown_by(const Picture& picture, const SuiteRun& run);

}  // namespace assay::harness
