// The integral of f(x) = e^(3x) over [0, 1] with a control variate. It is f's Taylor polynomial
// g(x) = 1 + 3x + 9x^2 / 2, of integral 4.
//   X = f(u) - c (g(u) - 4). E[X] = (e^3 - 1) / 3 for any c.
//   Var X = Var f - 2 c Cov(f, g) + c^2 Var g.
// The integral of f g is (11 e^3 - 2) / 6, that of g^2 is 104 / 5. The best c is Cov / Var g =
// 2.3006.

#include <algorithm>

#include "analytic/exponential.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

double control(double x) { return 1 + x * (3 + 4.5 * x); }
constexpr double control_integral = 4;

double variance(double c) {
  const double mean = analytic::integral();
  const double of_f = analytic::integral_of_square() - mean * mean;
  const double of_g = 104.0 / 5 - control_integral * control_integral;
  const double covariance = (11 * std::exp(3) - 2) / 6 - mean * control_integral;
  return of_f - 2 * c * covariance + c * c * of_g;
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const double c = parameters.number("coefficient");
  // f runs from 1 to e^3, g - 4 from -3 to 4.5.
  return averaging(Channel{.mean = analytic::integral(),
                           .variance = variance(c),
                           .low = 1 - std::max(4.5 * c, -3 * c),
                           .high = std::exp(3) + std::max(3 * c, -4.5 * c)},
                   [c](Stream& random) {
                     const double x = random.uniform();
                     return analytic::integrand(x) - c * (control(x) - control_integral);
                   });
}

}  // namespace

std::vector<Entry> analytic_control_variate() {
  return {{{.name = "analytic/control_variate",
            .summary = "The integral of e^(3x) over [0, 1] with a control variate.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by e^(3u) - c (1 + 3u + 9u^2/2 - "
                           "4). The variance, 1.194 at the default c, is smallest at c = 2.3006.",
            .parameters = {{.name = "coefficient",
                            .summary = "c, how much of the control variate is subtracted",
                            .fallback = "2.3",
                            .low = -1000,
                            .high = 1000}}},
           prepare}};
}

}  // namespace assay::plugins
