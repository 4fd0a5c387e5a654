#pragma once

// What `assay plan` prints: what a run would do, test by test.

#include <string>

#include "harness/run/unit_cost.h"

namespace assay::harness {

/// Tables of at most 100 columns: a suite's tests with method, primaries a secondary, looks, first
/// and last look's secondaries, cost at the last look, the effect that is found or shown there,
/// the share of it that is drawn on average if theta = 0, and what the pilot's gates say; then
/// totals. Plain text without colours.
std::string plan_text(const PlannedRun& planned, const UnitCosts& costs);

/// 1 where a selected test cannot come out as it expects because no method is valid or a source
/// stopped, else 0; 77 where all that is selected will be skipped; 4 where nothing is selected.
int plan_exit_code(const PlannedRun& planned, const UnitCosts& costs);

}  // namespace assay::harness
