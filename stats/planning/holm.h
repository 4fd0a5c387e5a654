#pragma once

#include <span>
#include <vector>

namespace assay::stats {

struct WeightedLogP {
  double log_p = 0;
  double weight = 1;
};

// What an entry that could not be tested enters a family with: p = 1.
inline constexpr double untested_log_p = 0;

// Holm (1979): adjusted p = max over j <= i of (m - j + 1) p_(j), capped at 1, in the caller's
// order. "adjusted <= alpha" controls the family-wise error under any dependence. Throws
// std::domain_error for NaN or positive log p.
std::vector<double> holm(std::span<const double> log_p);

// Weighted Holm: sorted by p / w, adjusted = max over j <= i of p_(j) (R + sum_{k >= j} w_(k)) /
// w_(j) with R = 1 - sum of all weights: what the weights leave short of one stays unspent. Never
// above the fixed share p / w. Throws for weights that are not positive or sum to more than 1 (plus
// rounding).
std::vector<double> weighted_holm(std::span<const WeightedLogP> entries);

}  // namespace assay::stats
