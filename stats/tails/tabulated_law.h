#pragma once

#include <array>
#include <span>
#include <vector>

#include "stats/basics/adaptive_quadrature.h"

namespace assay::stats {

// The distribution function of a density as a table: between two places the integral of the
// polynomial through the density at the nodes of the rule there.
struct TabulatedLaw {
  // The integral of the interpolant from the part's lower end on, at t in [-1, 1]: mass / 2 (t + 1)
  // + sum over k >= 1 of slope_(k-1) (P_(k+1)(t) - P_(k-1)(t)).
  using Slopes = std::array<double, AdaptiveQuadrature::nodes - 1>;

  std::vector<double> place;      // ascending
  std::vector<double> cumulated;  // mass up to each place, the first 0
  std::vector<Slopes> slopes;     // of each part, times the mass
  double total_error = 0;         // of the mass, estimated
  // Estimate of sup |table - law|: the largest departure plus the errors of all masses, over the
  // mass. The departure of a part is the largest distance, at seven places inside it, of what its
  // own seven nodes and those of its halves say of the law there, plus what a jump beyond the
  // outermost nodes may hide, and no less than a quarter of the departure of the part that it is a
  // half of. The table has the halves, which are nearer: by
  // 2^-7 where the density is smooth, by about 1/2 where it jumps.
  double error = 0;

  double total() const { return cumulated.back(); }
  // P(X <= x | a point): 0 below the first place, 1 above the last.
  double operator()(double x) const;
  // The same at each of these ascending values, bit by bit, in a quarter of the time: places are
  // walked along with them, and the polynomials of sixteen values do not wait for each other.
  std::vector<double> of_sorted(std::span<const double> values) const;
};

struct TableLimits {
  double departure = 1e-6;  // parts are halved until what is seen of their error is less
  int deepest_bisection = 24;
};

// Halves parts where the mass is and where the density is no polynomial, the worst first, from
// `parts` on: contiguous and ascending. The rule stops it when its evaluations are used up. Throws
// std::domain_error when there is no mass, or a density is negative or not finite.
TabulatedLaw tabulate(const AdaptiveQuadrature::Function& density, const std::vector<Span>& parts,
                      AdaptiveQuadrature& rule, TableLimits limits = {});

}  // namespace assay::stats
