#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "harness/base/progress.h"
#include "harness/run/evaluate.h"
#include "harness/sampling/executor.h"

namespace assay::harness {

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

}  // namespace assay::harness
