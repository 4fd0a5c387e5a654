// The integral of f(x) = e^(3x) over [0, 1] by antithetic pairs: X = (f(u) + f(1 - u)) / 2.
// E[X] = (e^3 - 1) / 3; f(u) f(1 - u) = e^3, so E[X^2] = ((e^6 - 1) / 6 + e^3) / 2. One primary
// costs two samples.

#include "analytic/exponential.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

double primary(Stream& random, Cost& cost) {
  const double x = random.uniform();
  cost.samples += 1;  // the other is counted as the primary itself
  return (analytic::integrand(x) + analytic::integrand(1 - x)) / 2;
}

std::shared_ptr<const Setup> prepare(Parameters&) {
  const double mean = analytic::integral();
  const double square = (analytic::integral_of_square() + std::exp(3)) / 2;
  // The pair is smallest at x = 1/2 and largest at the ends.
  return averaging(Channel{.mean = mean,
                           .variance = square - mean * mean,
                           .low = analytic::integrand(0.5),
                           .high = (1 + std::exp(3)) / 2},
                   primary);
}

}  // namespace

std::vector<Entry> analytic_antithetic() {
  return {{{.name = "analytic/antithetic",
            .summary = "The integral of e^(3x) over [0, 1] by antithetic pairs.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by (e^(3u) + e^(3 - 3u)) / 2. One "
                           "primary is one pair and costs two samples. Variance 3.1055."},
           prepare}};
}

}  // namespace assay::plugins
