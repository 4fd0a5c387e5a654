#pragma once

// The estimators of a suite.

#include "harness/run/planned_run.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Adds the suite's estimators: mean and variance with intervals. Dependent rows count as fewer
/// (stats::allowance_for_dependence). Descriptive: outside the family.
void add_pictures(const SuiteRun& run, reports::Suite& suite);

/// How much of an estimator a shard draws, by which merging chooses whose it shows.
reports::ShardPicture shard_picture(const Picture& picture, const SuiteRun& run);

reports::Cost cost_of(const Summary& summary);

}  // namespace assay::harness
