#pragma once

#include <span>

#include "stats/gates/assumption_gates.h"

namespace assay::stats {

// Rounding of values that are held against a continuous law by Kolmogorov and Smirnov. Rounded to a
// lattice, the empirical distribution steps by the mass of a lattice point where the law rises
// evenly, which moves the distance D by up to half of it.
// Value: C / (2 d), where C = sum c (c - 1) / (n (n - 1)) over the distinct values with counts c
// estimates sum p^2, the mean mass of a lattice point, and d is the distance that is rejected at
// `level`, sqrt(ln(2 / level) / (2 n)) (Massart 1990). Where the distinct values are not on one
// lattice of at most 2^20 steps, ties are no rounding: 0. green up to the limit .05, red above.
// Throws std::domain_error for fewer than 2 values, a non-finite value, or level outside (0, 1).
Gate quantisation_gate(std::span<const double> sorted, double level);

}  // namespace assay::stats
