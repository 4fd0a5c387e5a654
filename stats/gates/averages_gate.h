#pragma once

#include <cstddef>
#include <span>

#include "stats/basics/gate.h"

namespace assay::stats {

// Null hypothesis: `means` are independent means of `each` independent values of the law that
// `values` come from. So the G = floor(n / each) means of values 0, G, 2G, ...; 1, G + 1, ...; and
// the given ones are exchangeable. Their pooled ranks R = 0 ... N - 1, the mean rank for equal
// ones, have the law of a random order, whatever the law and its tails. Their
// normal scores are a = Phi^-1((R + 1/2) / N).
//
// The sum of a sees another place (van der Waerden 1952), the sum of a^2 another spread (Klotz
// 1962). Both are held against their permutation means and variances, as z. Value: the larger |z|.
// It is red with probability 1e-7, amber below .01. Near 0 and green if there are fewer than 16
// means on either side. Throws std::domain_error for each = 0 and for values that are not finite.
Gate averages_gate(std::span<const double> values, std::span<const double> means, std::size_t each);

}  // namespace assay::stats
