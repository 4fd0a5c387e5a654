// The area of the unit disc by darts thrown at the square [-1, 1]^2.
//
// X = 4 [u^2 + v^2 < 1] with u, v uniform in [-1, 1). The square has area 4 and the disc pi, so the
// expectation is pi; X is 4 times a Bernoulli variable, so its variance is pi (4 - pi).

#include <numbers>

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

double primary(Stream& random) {
  const double u = 2 * random.uniform() - 1;
  const double v = 2 * random.uniform() - 1;
  return u * u + v * v < 1 ? 4 : 0;
}

std::shared_ptr<const Setup> prepare(Parameters&) {
  constexpr double pi = std::numbers::pi;
  return averaging(
      Channel{.name = "area", .mean = pi, .variance = pi * (4 - pi), .low = 0, .high = 4}, primary);
}

}  // namespace

std::vector<Entry> analytic_dart_throwing() {
  return {{{.name = "analytic/dart_throwing",
            .summary = "The area of the unit disc by darts thrown at a square.",
            .description = "Estimates pi = the integral of [u^2 + v^2 < 1] over [-1, 1]^2 by "
                           "4 [u^2 + v^2 < 1] at uniform points. Variance pi (4 - pi)."},
           prepare}};
}

}  // namespace assay::plugins
