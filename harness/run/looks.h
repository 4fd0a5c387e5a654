#pragma once

#include <memory>
#include <vector>

#include "harness/base/progress.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

/// Draws observations in rounds of growing size until every test is decided or has taken its last
/// look: in each round every undecided test takes its next look. What a test sees at a look depends
/// on its own plan alone. Stops early when the user interrupts; tests are then left undecided.
void sample_in_looks(const std::vector<TestWork*>& tests,
                     const std::vector<std::shared_ptr<Pool>>& pools, unsigned threads,
                     Progress& progress);

}  // namespace assay::harness
