#pragma once

// The estimators of a suite.

#include "harness/run/planned_run.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Adds the estimators of the selected tests: mean and variance with intervals, of the test that
/// drew most. Dependent rows count as fewer (stats::allowance_for_dependence). Descriptive: outside
/// the family.
void add_estimators(const SuiteRun& run, reports::Suite& suite);

reports::Cost cost_of(const Summary& summary);

}  // namespace assay::harness
