#pragma once

// The output of `assay plan`: what a run would do, test by test.

#include <string>

#include "harness/run/planned_run.h"

namespace assay::harness {

/// Tables of at most 80 columns without colours. A test's row has its method, primaries per
/// secondary, looks, secondaries of the first and last look, and the last look's cost. It then has
/// the effect that this look finds, the expected share of it if theta = 0, and the pilot's gates.
/// Totals follow.
std::string plan_text(const PlannedRun& planned);

/// Returns 1 if a selected test cannot come out as expected: no method is valid, or a source
/// stopped. Returns 77 if all selected tests will be skipped, 4 if none is selected, else 0.
int plan_exit_code(const PlannedRun& planned);

}  // namespace assay::harness
