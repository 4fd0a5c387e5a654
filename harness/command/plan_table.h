#pragma once

// The output of `assay plan`: what a run would do, test by test.

#include <string>

#include "harness/run/planned_run.h"

namespace assay::harness {

/// Tables of at most 80 columns without colours: a row a test, with notes on the forecast and the
/// pilot's gates below it. Totals end the page.
std::string plan_text(const PlannedRun& planned);

/// Returns 1 if a selected test cannot come out as expected: no method is valid, or a source
/// stopped. Returns 77 if all selected tests will be skipped, 4 if none is selected, else 0.
int plan_exit_code(const PlannedRun& planned);

}  // namespace assay::harness
