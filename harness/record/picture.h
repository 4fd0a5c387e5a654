#pragma once

// The estimators of a suite, and how they compare.

#include <string>
#include <vector>

#include "harness/run/planned_run.h"
#include "reports/record/record.h"

namespace assay::harness {

/// An estimator's data for comparisons, as a shard records them.
struct Pictured {
  std::string name;
  bool averages = true;  ///< Its variance is that of a primary.
  reports::ShardPicture shown;
};

/// Adds the suite's estimators: mean and variance with intervals, and how each pair of estimators
/// of one quantity compares (`comparisons`). Dependent rows count as fewer
/// (stats::allowance_for_dependence). Descriptive: outside the family.
void add_pictures(const SuiteRun& run, reports::Suite& suite);

/// The data for comparisons.
Pictured pictured(const Picture& picture, const SuiteRun& run);
/// The names of the two estimators that a claim is about, else none.
std::vector<std::string> compared_by(const Question& question);

reports::Cost cost_of(const Summary& summary);

/// Compares every pair of estimators of one quantity: equal analytic means, or names paired in
/// `claimed`. It uses Welch's test on means and on the squared deviations of a primary,
/// and Holm over the pairs at level alpha. Empty for more than 40 estimators.
std::vector<reports::Comparison> comparisons(const std::vector<Pictured>& estimators,
                                             const std::vector<std::vector<std::string>>& claimed,
                                             double alpha);

}  // namespace assay::harness
