// The teaching estimators of I = (e^3 - 1) / 3, the integral of f(x) = e^(3x) over [0, 1].

#include "analytic/exponential.h"

#include <algorithm>
#include <cmath>

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

using namespace analytic;

std::shared_ptr<const Setup> uniform(Parameters&) {
  const double mean = integral();
  return averaging(Channel{.mean = mean,
                           .variance = integral_of_square() - mean * mean,
                           .low = 1,
                           .high = std::exp(3)},
                   [](Stream& random) { return integrand(random.uniform()); });
}

// f(u) f(1 - u) = e^3, so E[X^2] = ((e^6 - 1) / 6 + e^3) / 2.

std::shared_ptr<const Setup> antithetic(Parameters&) {
  const double mean = integral();
  const double square = (integral_of_square() + std::exp(3)) / 2;
  // The pair is smallest at x = 1/2 and largest at the ends.
  return averaging(Channel{.mean = mean,
                           .variance = square - mean * mean,
                           .low = integrand(0.5),
                           .high = (1 + std::exp(3)) / 2},
                   [](Stream& random, Cost& cost) {
                     const double x = random.uniform();
                     cost.samples += 1;  // the other is counted as the primary itself
                     return (integrand(x) + integrand(1 - x)) / 2;
                   });
}

// The control is f's Taylor polynomial g(x) = 1 + 3x + 9x^2 / 2, of integral 4.
//   Var X = Var f - 2 c Cov(f, g) + c^2 Var g.
// The integral of f g is (11 e^3 - 2) / 6, that of g^2 is 104 / 5.

double control(double x) { return 1 + x * (3 + 4.5 * x); }
constexpr double control_integral = 4;

std::shared_ptr<const Setup> control_variate(Parameters& parameters) {
  const double c = parameters.number("coefficient");
  const double mean = integral();
  const double of_f = integral_of_square() - mean * mean;
  const double of_g = 104.0 / 5 - control_integral * control_integral;
  const double covariance = (11 * std::exp(3) - 2) / 6 - mean * control_integral;
  // f runs from 1 to e^3, g - 4 from -3 to 4.5.
  return averaging(Channel{.mean = mean,
                           .variance = of_f - 2 * c * covariance + c * c * of_g,
                           .low = 1 - std::max(4.5 * c, -3 * c),
                           .high = std::exp(3) + std::max(3 * c, -4.5 * c)},
                   [c](Stream& random) {
                     const double x = random.uniform();
                     return integrand(x) - c * (control(x) - control_integral);
                   });
}

// X = e^(3x) / q(x) at x = (1 + 31 u)^(1/5) - 1. By parts, from t = 1 to 2,
//  `E[X^2] = (31 / 5) e^-6 [-e^(6t) (1 / 3t^3 + 1 / t^2 + 6 / t) + 36 Ei(6t)]`.

double near_point(Stream& random) {
  // The fifth root may round to 2 and beyond.
  return std::min(std::pow(1 + 31 * random.uniform(), 0.2) - 1, 1.0);
}

double antiderivative(double t) {
  return -std::exp(6 * t) * (1 / (3 * t * t * t) + 1 / (t * t) + 6 / t) + 36 * std::expint(6 * t);
}

std::shared_ptr<const Setup> importance(Parameters&) {
  const double mean = integral();
  const double square = 31 * std::exp(-6) / 5 * (antiderivative(2) - antiderivative(1));
  // X is smallest at x = 1/3, where (ln f)' = (ln q)' = 3, and largest at x = 1.
  return averaging(
      Channel{.mean = mean,
              .variance = square - mean * mean,
              .low = integrand(1.0 / 3) / near_density(1.0 / 3),
              .high = integrand(1) / near_density(1)},
      [](Stream& random) {
        const double x = near_point(random);
        return integrand(x) / near_density(x);
      },
      {{"x", sampler_of({.domain = Domain::interval,
                         .point = [](Stream& random) { return Point{near_point(random)}; },
                         .density = [](const Point& p) { return near_density(p[0]); },
                         .evaluate = [](const Point& p) { return integrand(p[0]); }})}});
}

// Var X = (1/k^2) sum_j Var_j, Var_j that of f at a uniform point of stratum j.
double stratified_variance(std::uint64_t strata) {
  const double k = static_cast<double>(strata);
  double sum = 0;
  for (std::uint64_t j = 0; j < strata; ++j) {
    const double a = static_cast<double>(j) / k;
    const double width = static_cast<double>(j + 1) / k - a;
    const double mean = std::exp(3 * a) * std::expm1(3 * width) / (3 * width);
    const double square = std::exp(6 * a) * std::expm1(6 * width) / (6 * width);
    sum += square - mean * mean;
  }
  return sum / (k * k);
}

std::shared_ptr<const Setup> stratified(Parameters& parameters) {
  const std::uint64_t strata = parameters.count("strata");
  return averaging(Channel{.mean = integral(),
                           .variance = stratified_variance(strata),
                           .low = 1,
                           .high = std::exp(3)},
                   [strata](Stream& random, Cost& cost) {
                     const double k = static_cast<double>(strata);
                     double sum = 0;
                     for (std::uint64_t j = 0; j < strata; ++j) {
                       sum += integrand((static_cast<double>(j) + random.uniform()) / k);
                     }
                     cost.samples += strata - 1;  // the first is counted as the primary itself
                     return sum / k;
                   });
}

std::shared_ptr<const Setup> zero_variance(Parameters&) {
  const double mean = integral();
  // Two roundings, and those of the sum of primaries.
  constexpr double rounding = 0x1p-40;
  return averaging(Channel{.mean = mean,
                           .variance = 0,
                           .low = mean * (1 - rounding),
                           .high = mean * (1 + rounding),
                           .rounding = 2 * mean * rounding},
                   [](Stream& random) {
                     // The variance is zero but for rounding, which a t test mistakes for a scale.
                     const double x = std::log1p(random.uniform() * std::expm1(3)) / 3;
                     const double density = integrand(x) / integral();
                     return integrand(x) / density;
                   });
}

// n (E[I^] - I) -> I Var g - Cov(f, g) = -0.50012,  n Var I^ -> Var(f - I g).

std::shared_ptr<const Setup> ratio(Parameters&) {
  // A ratio of sums lies between the extremes of f / g, at x = 1/3 and x = 1.
  return ratio_setup(Channel{.mean = integral(),
                             .low = integrand(1.0 / 3) / near_density(1.0 / 3),
                             .high = integrand(1) / near_density(1)},
                     same_point, ratio_of_sums);
}

std::shared_ptr<const Setup> jackknifed(Parameters&) {
  const auto both_left_out = [](const RatioPair& without, const RatioPair& /*all*/) {
    return without.full / without.target;
  };
  return ratio_setup(Channel{.mean = integral()}, same_point, jackknife(both_left_out));
}

}  // namespace

std::vector<Entry> analytic_exponential() {
  return {
      {{.name = "analytic/exponential_uniform",
        .summary = "The integral of e^(3x) over [0, 1] at uniform points.",
        .description = "Estimates (e^3 - 1) / 3 = 6.361846 by e^(3u). Variance (e^6 - 1) / 6 - "
                       "6.361846^2 = 26.5984."},
       uniform},
      {{.name = "analytic/antithetic",
        .summary = "The integral of e^(3x) over [0, 1] by antithetic pairs.",
        .description = "Estimates (e^3 - 1) / 3 = 6.361846 by (e^(3u) + e^(3 - 3u)) / 2. One "
                       "primary is one pair and costs two samples. Variance 3.1055."},
       antithetic},
      {{.name = "analytic/control_variate",
        .summary = "The integral of e^(3x) over [0, 1] with a control variate.",
        .description = "Estimates (e^3 - 1) / 3 = 6.361846 by e^(3u) - c (1 + 3u + 9u^2/2 - 4). "
                       "The variance, 1.194 at the default c, is smallest at c = 2.3006.",
        .parameters = {number_parameter("coefficient",
                                        "c, how much of the control variate is subtracted", "2.3",
                                        {-1000, 1000})}},
       control_variate},
      {{.name = "analytic/exponential_importance",
        .summary = "The integral of e^(3x) over [0, 1] by importance sampling.",
        .description = "Estimates (e^3 - 1) / 3 = 6.361846 by e^(3x) / q(x), x of density q(x) = 5 "
                       "(1 + x)^4 / 31 by inversion. Variance 0.3858."},
       importance},
      {{.name = "analytic/stratified",
        .summary = "The integral of e^(3x) over [0, 1] by stratified sampling.",
        .description = "Estimates (e^3 - 1) / 3 = 6.361846 by the mean of e^(3x) at one uniform "
                       "point in each of k equal strata. One primary is one such mean and costs k "
                       "samples. The variance falls like k^-3.",
        .parameters = {count_parameter("strata", "k, the number of strata", "16", {1, 10000})}},
       stratified},
      {{.name = "analytic/zero_variance",
        .summary = "The integral of e^(3x) over [0, 1] from the perfect density.",
        .description = "Estimates (e^3 - 1) / 3 = 6.361846 by f(x) / p(x) with p = f / I: every "
                       "observation is the integral, to rounding."},
       zero_variance},
      {{.name = "analytic/ratio",
        .summary = "The integral of e^(3x) over [0, 1] by weighted importance sampling.",
        .description =
            "Estimates (e^3 - 1) / 3 = 6.361846 by sum e^(3x) / sum g(x), g(x) = 5 (1 + x)^4 / 31 "
            "of integral 1, x uniform. The bias times the number of primaries tends to -0.50012.",
        .bias = BiasClass::inverse_primaries,
        .averages = false},
       ratio},
      {{.name = "analytic/jackknifed_ratio",
        .summary = "Weighted importance sampling without the first term of its bias.",
        .description = "The jackknife of R, the estimate of analytic/ratio: M R - (M - 1) times "
                       "the mean of the M ratios with one point left out (Quenouille 1956). Its "
                       "bias falls like 1 / M^2, that of R like 1 / M. Its variance is that of R "
                       "up to terms of order 1 / M^2. With one point it is R.",
        .bias = BiasClass::inverse_primaries,
        .averages = false},
       jackknifed}};
}

}  // namespace assay::plugins
