#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/record/record.h"
#include "stats/basics/moments.h"

namespace assay::harness {

/// An estimator's data for comparisons. A shard's are read from its record.
struct PicturedChannel {
  std::string name;
  std::optional<double> mean;  ///< Analytic mean.
  stats::Moments moments;
};
struct Pictured {
  std::string name;
  bool drawn = true;     ///< False: it threw.
  bool image = false;    ///< Compared by claims, not pixel by pixel.
  double averaged = 1;   ///< Primaries that an observation averages.
  bool averages = true;  ///< Its variance is that of a primary.
  std::vector<PicturedChannel> channels = {};
};

/// True if moments suffice for intervals of mean and variance.
bool has_spread(const stats::Moments& moments);

/// Compares every pair of estimators of one quantity: equal analytic means, or names paired in
/// `claimed`. It uses Welch's test on means and on the squared deviations of a primary,
/// and Holm over the pairs at level alpha. Empty for more than 40 estimators.
std::vector<reports::Comparison> comparisons(const std::vector<Pictured>& estimators,
                                             const std::vector<std::vector<std::string>>& claimed,
                                             double alpha);

}  // namespace assay::harness
