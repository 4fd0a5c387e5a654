#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "stats/gates/assumption_gates.h"

namespace assay::stats {

// Generalised Pareto law of exceedances y >= 0: P(Y > y) = (1 + shape y / scale)^(-1 / shape).
// Moments of order below 1 / shape exist.
struct GeneralisedPareto {
  double shape = 0;      // Shrunk towards 1/2 by ten imagined observations (Vehtari et al. 2024).
  double raw_shape = 0;  // As fitted, not shrunk.
  double scale = 0;
};

// Fit to N ascending positive exceedances by the profile posterior mean of Zhang & Stephens (2009,
// Technometrics 51). The parameter theta = -shape / scale runs over G = 30 + floor(sqrt N) values.
//   Value j: 1 / y_N + (1 - sqrt(G / (j - 1/2))) / (3 y_q),  q = floor(N / 4 + 1/2).
// Weights come from the profile likelihood N (ln(-theta / k) - k - 1), k = mean ln(1 - theta y).
// The shrunk shape is (N raw + 5) / (N + 10) (Vehtari et al. 2024, J. Mach. Learn. Res. 25). Throws
// std::domain_error: fewer than five, not ascending, not positive and finite.
GeneralisedPareto fit_generalised_pareto(std::span<const double> exceedances);

// Number of values that make the tail: min(n / 5, 3 sqrt n), rounded up (Vehtari et al. 2024).
std::size_t pareto_tail_size(std::uint64_t n);

// The shape k of one tail of a sample of `count` values.
struct ParetoTail {
  double shape = 0;
  double low = 0;               // Lower confidence limit of the shape.
  std::size_t exceedances = 0;  // Number that were fitted.
};

// `largest` holds, in ascending order, the pareto_tail_size(count) + 1 largest values of the
// sample. More are ignored. For the left tail pass the smallest values with their signs changed.
// The smallest of them is the threshold, and the others less the threshold are fitted. Values tied
// with the threshold are left out. The limit solves k = low + z (1 + low) / sqrt(exceedances),
// one-sided at `confidence`, for the smaller of raw and shrunk shape. The asymptotic standard error
// is (1 + k) / sqrt N (Smith 1987), up to a quarter above the simulated one. Throws
// std::domain_error: too few values, not ascending, not finite, fewer than five exceedances above
// the threshold (a tail without spread has no shape).
ParetoTail pareto_tail(std::span<const double> largest, std::uint64_t count,
                       double confidence = 0.9999);

// The largest shape at which a claim can be tested.
//   any_mean: s(n) = min(.7, 1 - 1 / log10 n). Beyond it sums of n values have not settled.
//   mean:     min(1/2, s(n)). The variance exists, as t and Welch need.
//   variance: min(1/4, s(n)). The fourth moment exists.
enum class TailClaim { mean, variance, any_mean };
double pareto_limit(TailClaim claim, std::uint64_t count);

// Gate "tail". Value k; red when its confidence limit exceeds the claim's. Green up to the limit. A
// tail without spread (fewer than five exceedances) counts as bounded: green with value and low 0.
Gate pareto_gate(std::span<const double> largest, std::uint64_t count, TailClaim claim);

}  // namespace assay::stats
