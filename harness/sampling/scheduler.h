#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/base/progress.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

struct Drawing {
  unsigned threads = 0;  ///< 0: all cores
  std::string phase = "sampling";
};

/// Draws every pool up to its request. Blocks go out in order and are folded in order, so the
/// contents do not depend on the number of threads. Stops early, leaving pools short, when the user
/// interrupts.
void draw_all(const std::vector<std::shared_ptr<Pool>>& pools, const Drawing& drawing,
              Progress& progress);

}  // namespace assay::harness
