#pragma once

// The pilot: a few primaries of each estimator, from streams of their own, by which the sizes and
// methods of the tests are chosen. No test ever sees these numbers.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/pool.h"
#include "harness/progress.h"
#include "harness/question.h"

namespace assay::harness {

/// What a pilot tells of an estimator, by channel.
struct Pilot {
  std::vector<stats::Moments> channels;  ///< of secondaries of `primaries` primaries
  std::uint64_t primaries = 1;
  std::string trouble = "";  ///< why there are no numbers: the estimator threw
};

/// By estimator name. Averaging estimators at one primary, others at the suite's `primaries`.
/// Estimators of bounded data have none: their rows are the test's own.
using Pilots = std::map<std::string, Pilot>;

struct PilotRun {
  std::uint64_t seed;
  unsigned threads;
};

Pilots run_pilots(const std::vector<const PreparedEstimator*>& estimators, const PilotRun& run,
                  Progress& progress);

}  // namespace assay::harness
