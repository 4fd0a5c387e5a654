// The integral of e^(3x) over [0, 1] at uniform points: X = e^(3u).
// E[X] = (e^3 - 1) / 3, Var X = (e^6 - 1) / 6 - E[X]^2.

#include "analytic/exponential.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters&) {
  const double mean = analytic::integral();
  return averaging(Channel{.mean = mean,
                           .variance = analytic::integral_of_square() - mean * mean,
                           .low = 1,
                           .high = std::exp(3)},
                   [](Stream& random) { return analytic::integrand(random.uniform()); });
}

}  // namespace

std::vector<Entry> analytic_exponential_uniform() {
  return {{{.name = "analytic/exponential_uniform",
            .summary = "The integral of e^(3x) over [0, 1] at uniform points.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by e^(3u). Variance "
                           "(e^6 - 1) / 6 - 6.361846^2 = 26.5984."},
           prepare}};
}

}  // namespace assay::plugins
