// A Pareto variable X = u^(-1/a) of tail index a, P(X > x) = x^-a for x >= 1: what a Monte Carlo
// estimator with a bad density looks like. E[X] = a / (a - 1); Var X = a / ((a - 1)^2 (a - 2)) if
// a > 2, else infinite; the k-th moment exists for k < a only.

#include <cmath>

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

std::optional<double> variance(double a) {
  if (a <= 2) return {};
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
                           "4 only.",
            .parameters = {{.name = "index",
                            .summary = "a, the tail index",
                            .fallback = "3",
                            .low = 1,
                            .high = 1000,
                            .low_excluded = true}}},
           prepare}};
}

}  // namespace assay::plugins
