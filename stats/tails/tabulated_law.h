#pragma once

#include <array>
#include <vector>

#include "stats/basics/adaptive_quadrature.h"

namespace assay::stats {

// The distribution function of a density as a table. Between two places it is the integral of the
// polynomial through the density at the rule's nodes there.
struct TabulatedLaw {
  // Legendre coefficients. The integral of the interpolant up to t in [-1, 1] is
  //  `mass / 2 (t + 1) + sum over k >= 1 of slope_(k-1) (P_(k+1)(t) - P_(k-1)(t))`.
  using Slopes = std::array<double, AdaptiveQuadrature::nodes - 1>;

  std::vector<double> place;      // Ascending.
  std::vector<double> cumulated;  // Mass up to each place, the first 0.
  std::vector<Slopes> slopes;     // Slopes of each part, times the mass.
  double total_error = 0;         // Estimated error of the mass.
  // Estimate of sup |table - law|: the largest departure plus the errors of all masses, over the
  // mass. A part's departure compares the law from its own nodes with that from its halves' nodes,
  // at seven places inside. It adds what a jump beyond the outermost nodes may hide. It is at least
  // a quarter of the departure of the part that it is a half of. The table has the halves, which
  // are nearer: by 2^-7 where the density is smooth, by about 1/2 where it jumps.
  double error = 0;

  double total() const { return cumulated.back(); }
  // P(X <= x | a point): 0 below the first place, 1 above the last.
  double operator()(double x) const;
};

// Halves parts where the mass is and where the density is no polynomial, the worst first. The
// visible part of their error is then below 1e-6. `parts` are contiguous and ascending. It stops
// when the rule's evaluations are used up. Throws std::domain_error when there is no mass, or a
// density is negative or not finite.
TabulatedLaw tabulate(const AdaptiveQuadrature::Function& density, const std::vector<Span>& parts,
                      AdaptiveQuadrature& rule);

}  // namespace assay::stats
