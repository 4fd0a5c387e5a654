// A constant with a rare spike: X = 1/2 + h [u < p]. E[X] = 1/2 + p h, Var X = p (1 - p) h^2. In N
// primaries the spike stays unseen with probability (1 - p)^N, and all of them are then equal.

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const double p = parameters.number("probability");
  const double height = parameters.number("height");
  return averaging(Channel{.mean = 0.5 + p * height,
                           .variance = p * (1 - p) * height * height,
                           .low = 0.5,
                           .high = 0.5 + height},
                   [=](Stream& random) { return random.uniform() < p ? 0.5 + height : 0.5; });
}

}  // namespace

std::vector<Entry> analytic_rare_spike() {
  return {{{.name = "analytic/rare_spike",
            .summary = "The constant 1/2 with a rare spike.",
            .description = "Estimates 1/2 + p h by 1/2, and with probability p by 1/2 + h. "
                           "Variance p (1 - p) h^2.",
            .parameters = {{.name = "probability",
                            .summary = "p, of a spike",
                            .fallback = "1e-5",
                            .low = 0,
                            .high = 1},
                           {.name = "height",
                            .summary = "h, what a spike adds",
                            .fallback = "1000",
                            .low = 0,
                            .high = 1e12}}},
           prepare}};
}

}  // namespace assay::plugins
