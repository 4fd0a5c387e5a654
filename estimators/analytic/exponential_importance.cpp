// The integral of e^(3x) over [0, 1] by importance sampling from q(x) = 5 (1 + x)^4 / 31.
//
// X = e^(3x) / q(x) at x = (1 + 31 u)^(1/5) - 1. E[X] = (e^3 - 1) / 3. By parts, from t = 1 to 2,
//   E[X^2] = (31 / 5) e^-6 [-e^(6t) (1 / 3t^3 + 1 / t^2 + 6 / t) + 36 Ei(6t)].

#include <algorithm>
#include <cmath>

#include "analytic/exponential.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

class NearDensitySampler final : public Sampler {
 public:
  Domain domain() const override { return Domain::interval; }
  SamplerDraw sample(Stream& random) const override {
    // The fifth root may round to 2 and beyond.
    const double x = std::min(std::pow(1 + 31 * random.uniform(), 0.2) - 1, 1.0);
    const double density = analytic::near_density(x);
    return {.point = {x}, .density = density, .weight = analytic::integrand(x) / density};
  }
  double density(const Point& p) const override { return analytic::near_density(p[0]); }
  double evaluate(const Point& p) const override { return analytic::integrand(p[0]); }
};

double antiderivative(double t) {
  return -std::exp(6 * t) * (1 / (3 * t * t * t) + 1 / (t * t) + 6 / t) + 36 * std::expint(6 * t);
}

std::shared_ptr<const Setup> prepare(Parameters&) {
  const double mean = analytic::integral();
  const double square = 31 * std::exp(-6) / 5 * (antiderivative(2) - antiderivative(1));
  const auto sampler = std::make_shared<NearDensitySampler>();
  // X is smallest at x = 1/3, where (ln f)' = (ln q)' = 3, and largest at x = 1.
  return averaging(Channel{.mean = mean,
                           .variance = square - mean * mean,
                           .low = analytic::integrand(1.0 / 3) / analytic::near_density(1.0 / 3),
                           .high = analytic::integrand(1) / analytic::near_density(1)},
                   [](Stream& random) { return NearDensitySampler().sample(random).weight; },
                   {{"x", sampler}});
}

}  // namespace

std::vector<Entry> analytic_exponential_importance() {
  return {{{.name = "analytic/exponential_importance",
            .summary = "The integral of e^(3x) over [0, 1] by importance sampling.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by e^(3x) / q(x), x of density q(x) "
                           "= 5 (1 + x)^4 / 31 by inversion. Variance 0.3858."},
           prepare}};
}

}  // namespace assay::plugins
