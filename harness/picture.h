#pragma once

#include "harness/record_of.h"

namespace assay::harness {

/// The suite's estimators side by side: mean and variance of each with intervals, and where each
/// pair of estimators of one quantity stands (equal analytic means, or a claim that compares them):
/// Welch on the means, log-variance ratio on the variances of a primary, Holm over the pairs at the
/// suite's alpha. Descriptive: outside the family.
void add_pictures(const SuiteRun& run, reports::Suite& suite);

reports::Cost cost_of(const Summary& summary);

}  // namespace assay::harness
