#pragma once

// Where each pair of a suite's estimators stands.

#include <optional>
#include <string>
#include <vector>

#include "reports/record/record.h"
#include "stats/basics/moments.h"

namespace assay::harness {

/// An estimator as far as comparing takes: of a shard this is read from its record.
struct PicturedChannel {
  std::string name;
  std::optional<double> mean;  ///< analytic
  stats::Moments moments;
};
struct Pictured {
  std::string name;
  bool drawn = true;     ///< false: it threw
  bool image = false;    ///< compared by claims, not pixel by pixel
  double averaged = 1;   ///< primaries that an observation averages
  bool averages = true;  ///< so that its variance is that of a primary
  std::vector<PicturedChannel> channels = {};
};

/// Whether moments suffice for intervals of mean and variance.
bool has_spread(const stats::Moments& moments);

/// Every pair of estimators of one quantity (equal analytic means, or a claim that compares them:
/// `claimed` holds their names in pairs): Welch on the means, log-variance ratio on the variances
/// of a primary, Holm over the pairs at level alpha. Nothing of more than 40 estimators.
std::vector<reports::Comparison> comparisons(const std::vector<Pictured>& estimators,
                                             const std::vector<std::vector<std::string>>& claimed,
                                             double alpha);

}  // namespace assay::harness
