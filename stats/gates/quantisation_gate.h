#pragma once

#include <span>

#include "stats/gates/assumption_gates.h"

namespace assay::stats {

// Gate on the rounding of values that are held against a continuous law by Kolmogorov and Smirnov.
// On a lattice the empirical distribution steps by the mass of a lattice point. That moves the
// distance D by up to half of it.
//
// Value: C / (2 d), C = sum c (c - 1) / (n (n - 1)) over the distinct values with counts c. C
// estimates sum p^2, the mean mass of a lattice point. The distance d = sqrt(ln(2 / level) / (2 n))
// is the one rejected at `level` (Massart 1990). The value is 0 if the distinct values are not on
// one lattice of at most 2^20 steps. Green up to the limit .05, red above. Throws std::domain_error
// for fewer than 2 values, a non-finite value, or level outside (0, 1).
Gate quantisation_gate(std::span<const double> sorted, double level);

}  // namespace assay::stats
