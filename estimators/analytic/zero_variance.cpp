// The integral of f(x) = e^(3x) over [0, 1] by importance sampling from f / I itself: X = f(x) /
// (f(x) / I) = I at x = ln(1 + u (e^3 - 1)) / 3, whatever is drawn. The variance is zero but for
// rounding, which a t test mistakes for a scale.

#include "analytic/exponential.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

double primary(Stream& random) {
  const double x = std::log1p(random.uniform() * std::expm1(3)) / 3;
  const double density = analytic::integrand(x) / analytic::integral();
  return analytic::integrand(x) / density;
}

std::shared_ptr<const Setup> prepare(Parameters&) {
  const double mean = analytic::integral();
  // Two roundings, and those of the sum of primaries.
  constexpr double rounding = 0x1p-40;
  return averaging(Channel{.mean = mean,
                           .variance = 0,
                           .low = mean * (1 - rounding),
                           .high = mean * (1 + rounding),
                           .rounding = 2 * mean * rounding},
                   primary);
}

}  // namespace

std::vector<Entry> analytic_zero_variance() {
  return {
      {{.name = "analytic/zero_variance",
        .summary = "The integral of e^(3x) over [0, 1] from the perfect density.",
        .description = "Estimates (e^3 - 1) / 3 = 6.361846 by f(x) / p(x) with p = f / I: every "
                       "observation is the integral, to rounding."},
       prepare}};
}

}  // namespace assay::plugins
