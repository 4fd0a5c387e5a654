// A Pareto variable X = u^(-1/a) of tail index a: P(X > x) = x^-a for x >= 1. An estimator with a
// bad density looks like it. E[X] = a / (a - 1). Var X = a / ((a - 1)^2 (a - 2)) if a > 2, else it
// is infinite. The k-th moment exists for k < a only.
//
// u is the middle of one of 2^52 equal cells, never below 2^-53. The share of the k-th moment from
// below is 2^(-53 (1 - k/a)). It is less than 1e-4 for the mean if a >= 1.34, and for the variance
// if a >= 2.67. Nothing is declared below.

#include <cmath>

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

constexpr double least_index = 1.34;
constexpr double least_index_of_variance = 2.67;

std::optional<double> variance(double a) {
  if (a < least_index_of_variance) return {};
  return a / ((a - 1) * (a - 1) * (a - 2));
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const double a = parameters.number("index");
  return averaging(Channel{.mean = a / (a - 1), .variance = variance(a), .low = 1},
                   [a](Stream& random) { return std::pow(random.uniform_open(), -1 / a); });
}

}  // namespace

std::vector<Entry> analytic_heavy_tail() {
  return {{{.name = "analytic/heavy_tail",
            .summary = "A Pareto variable: heavy tails, infinite variance up to index 2.",
            .description = "Estimates a / (a - 1) by u^(-1/a). Variance a / ((a - 1)^2 (a - 2)) "
                           "for a tail index a > 2 and infinite below; the kurtosis exists for a > "
                           "4 only. u has 52 bits: the indices are those at which what lies "
                           "beyond its smallest value is less than 1e-4 of the mean, and the "
                           "variance is declared from 2.67 on, where that holds for it as well.",
            .parameters = {{.name = "index",
                            .summary = "a, the tail index",
                            .fallback = "3",
                            .low = least_index,
                            .high = 1000}}},
           prepare}};
}

}  // namespace assay::plugins
