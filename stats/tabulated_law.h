#pragma once

#include <vector>

#include "stats/adaptive_quadrature.h"

namespace assay::stats {

// The distribution function of a density as a table, linear between its places, with what the table
// may be off.
struct TabulatedLaw {
  std::vector<double> place;      // ascending
  std::vector<double> cumulated;  // mass up to each place, the first 0
  double total_error = 0;         // of the mass, estimated
  // Estimate of sup |table - law|: the largest chord plus the errors of all masses, over the mass.
  // The chord is half the difference of the masses of a part's halves, i.e. what the law departs
  // from a line at the part's middle, and no less than a quarter of the chord of the part that it
  // is a half of. As the middle is itself a place of the table, what is left is a quarter of the
  // chord where the density is smooth and about the whole where it jumps.
  double error = 0;

  double total() const { return cumulated.back(); }
  // P(X <= x | a point): 0 below the first place, 1 above the last.
  double operator()(double x) const;
};

struct TableLimits {
  double chord = 4e-6;  // parts are halved until they depart from a line by less
  int deepest_bisection = 24;
};

// Halves parts where the mass is and where the density bends, the worst first, from `parts` on:
// contiguous and ascending. The rule stops it when its evaluations are used up. Throws
// std::domain_error when there is no mass, or a density is negative or not finite.
TabulatedLaw tabulate(const AdaptiveQuadrature::Function& density, const std::vector<Span>& parts,
                      AdaptiveQuadrature& rule, TableLimits limits = {});

}  // namespace assay::stats
