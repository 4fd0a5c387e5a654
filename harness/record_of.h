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
};

/// A suite in a run: what it says, what was prepared from it, what came out.
struct SuiteRun {
  Suite suite;
  std::uint64_t seed = 1;
  std::map<std::string, PreparedEstimator> estimators;
  Pilots pilots = {};  ///< of the estimators of the selected tests
  std::vector<TestWork> tests = {};
  std::vector<Picture> pictures = {};
  bool holm = false;  ///< the whole family ran
};

reports::Record record_of(const std::vector<std::unique_ptr<SuiteRun>>& runs,
                          const RunOptions& options);

/// One test's numbers and verdict.
reports::Test record_of_test(const TestWork& work, const std::string& file, bool holm);

reports::Tool this_tool();
reports::Environment this_environment(unsigned threads);
/// The time now as "2000-01-01T00:00:00Z".
std::string utc_now();

}  // namespace assay::harness
