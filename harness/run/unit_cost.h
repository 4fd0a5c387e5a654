#pragma once

// What one secondary estimate costs, measured on the pilot's or a few from streams of their own.

#include <map>
#include <variant>

#include "harness/run/planned_run.h"

namespace assay::harness {

struct UnitCost {
  double rays = 0;
  double samples = 0;
  double seconds = 0;  ///< CPU seconds
};

/// By the pool that a test reads or a picture is drawn from: what its secondaries cost, or why they
/// could not be drawn. Missing are recorded data, which are only read.
using UnitCosts = std::map<const Pool*, std::variant<UnitCost, Fault>>;

/// Draws about 16 thousand primaries, each element of an image counted, of each pool's estimator or
/// sampler, at the pool's own primaries a secondary: one primary alone costs more than its share of
/// many. Of one that does not average the pilot tells. The pools themselves stay as they are.
UnitCosts measure_costs(const PlannedRun& planned, unsigned threads, Progress& progress);

}  // namespace assay::harness
