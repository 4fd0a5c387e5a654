#pragma once

// The cost of one secondary estimate, measured on the pilot or a few from separate streams.

#include <map>
#include <variant>

#include "harness/run/planned_run.h"

namespace assay::harness {

struct UnitCost {
  double rays = 0;
  double samples = 0;
  double seconds = 0;  ///< CPU seconds
};

/// The cost of secondaries by pool, or why they could not be drawn. Recorded data, which are only
/// read, are missing.
using UnitCosts = std::map<const Pool*, std::variant<UnitCost, Fault>>;

/// Draws about 16 thousand primaries (times an image's elements) for each pool, at its primaries
/// for each secondary. A single primary would cost more than its share. Non-averaging estimators
/// use the pilot. Does not change the pools.
UnitCosts measure_costs(const PlannedRun& planned, const std::shared_ptr<Executor>& executor,
                        Progress& progress);

}  // namespace assay::harness
