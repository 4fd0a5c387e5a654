#pragma once

#include "harness/record/comparisons.h"
#include "harness/record/record_of.h"

namespace assay::harness {

/// Adds the suite's estimators: mean and variance with intervals, and how each pair of estimators
/// of one quantity compares (`comparisons`). Dependent rows count as fewer
/// (stats::allowance_for_dependence). Descriptive: outside the family.
void add_pictures(const SuiteRun& run, reports::Suite& suite);

/// The data for comparisons.
Pictured pictured(const Picture& picture, const SuiteRun& run);
/// The names of the two estimators that a claim is about, else none.
std::vector<std::string> compared_by(const Question& question);

reports::Cost cost_of(const Summary& summary);

}  // namespace assay::harness
