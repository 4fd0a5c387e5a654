#pragma once

#include <memory>
#include <vector>

#include "harness/base/progress.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

/// Draws in rounds: in each, every undecided test takes its next look. It ends when every test is
/// decided or has taken its last look. A test's data depend on its own plan alone. Stops early when
/// the user interrupts; tests are then left undecided.
void sample_in_looks(const std::vector<TestWork*>& tests,
                     const std::vector<std::shared_ptr<Pool>>& pools, unsigned threads,
                     Progress& progress);

}  // namespace assay::harness
