// The integral of f(x) = e^(3x) over [0, 1] with k strata, one point in each:
// X = (1/k) sum_j f((j + u_j) / k). E[X] = (e^3 - 1) / 3, Var X = (1/k^2) sum_j Var_j, Var_j that
// of f at a uniform point of stratum j. One primary costs k samples.

#include "analytic/exponential.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

// Var f(x), x uniform in [a, b].
double variance_between(double a, double b) {
  const double mean = std::exp(3 * a) * std::expm1(3 * (b - a)) / (3 * (b - a));
  const double square = std::exp(6 * a) * std::expm1(6 * (b - a)) / (6 * (b - a));
  return square - mean * mean;
}

double variance(std::uint64_t strata) {
  const double k = static_cast<double>(strata);
  double sum = 0;
  for (std::uint64_t j = 0; j < strata; ++j) {
    sum += variance_between(static_cast<double>(j) / k, static_cast<double>(j + 1) / k);
  }
  return sum / (k * k);
}

double primary(std::uint64_t strata, Stream& random, Cost& cost) {
  const double k = static_cast<double>(strata);
  double sum = 0;
  for (std::uint64_t j = 0; j < strata; ++j) {
    sum += analytic::integrand((static_cast<double>(j) + random.uniform()) / k);
  }
  cost.samples += strata - 1;  // the first is counted as the primary itself
  return sum / k;
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const std::uint64_t strata = parameters.count("strata");
  return averaging(Channel{.mean = analytic::integral(),
                           .variance = variance(strata),
                           .low = 1,
                           .high = std::exp(3)},
                   [strata](Stream& random, Cost& cost) { return primary(strata, random, cost); });
}

}  // namespace

std::vector<Entry> analytic_stratified() {
  return {{{.name = "analytic/stratified",
            .summary = "The integral of e^(3x) over [0, 1] by stratified sampling.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by the mean of e^(3x) at one "
                           "uniform point in each of k equal strata. One primary is one such mean "
                           "and costs k samples. The variance falls like k^-3.",
            .parameters = {{.name = "strata",
                            .type = ParameterType::count,
                            .summary = "k, the number of strata",
                            .fallback = "16",
                            .low = 1,
                            .high = 10000}}},
           prepare}};
}

}  // namespace assay::plugins
