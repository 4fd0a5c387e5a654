#pragma once

#include <string>
#include <vector>

#include "reports/record/record.h"
#include "stats/basics/moments.h"

namespace assay::harness {

/// An estimator's data for comparisons, as a shard records them.
struct Pictured {
  std::string name;
  bool averages = true;  ///< Its variance is that of a primary.
  reports::ShardPicture shown;
};

reports::Moments recorded(const stats::Moments& moments);

/// True if moments suffice for intervals of mean and variance.
bool has_spread(const stats::Moments& moments);

/// Compares every pair of estimators of one quantity: equal analytic means, or names paired in
/// `claimed`. It uses Welch's test on means and on the squared deviations of a primary,
/// and Holm over the pairs at level alpha. Empty for more than 40 estimators.
std::vector<reports::Comparison> comparisons(const std::vector<Pictured>& estimators,
                                             const std::vector<std::vector<std::string>>& claimed,
                                             double alpha);

}  // namespace assay::harness
