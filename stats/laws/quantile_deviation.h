#pragma once

#include <optional>
#include <span>

#include "stats/basics/moments.h"

namespace assay::stats {

// Planning of a quantile's test by quantile_standard_deviation (quantile_test.h), which needs the
// density at the quantile. These estimate it. If it differs, the size is off by its ratio.

// With the density that a sample shows over `distance` on the quantile's sparser side, less two of
// its standard errors. A part below 64 values is taken for the tail: excesses of the 128 outermost
// over the next value count as generalised Pareto, by their mean and variance (Hosking & Wallis
// 1987). Nothing for fewer than 256 finite values, or if the density does not show.
std::optional<double> observed_quantile_deviation(std::span<const double> sample,
                                                  double probability, double distance);

// Of means of `averaged` values each with these moments: a normal density, stretched by Cornish and
// Fisher's first term to a fifth at least.
double quantile_deviation_of_means(const Moments& values, double averaged, double probability);

}  // namespace assay::stats
