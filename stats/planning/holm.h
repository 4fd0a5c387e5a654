#pragma once

#include <span>
#include <vector>

namespace assay::stats {

struct WeightedLogP {
  double log_p = 0;
  double weight = 1;
};

// The ln p with which a test that could not be run enters a family: p = 1.
inline constexpr double untested_log_p = 0;

// Weighted Holm (1979), sorted by p / w.
//   Adjusted = max over j <= i of p_(j) (R + sum_{k >= j} w_(k)) / w_(j),  R = 1 - sum of weights.
// R stays unspent. "adjusted <= alpha" controls the family-wise error under any dependence. The
// result is never above the fixed share p / w, capped at 1. Results stand in the caller's order.
// Throws std::domain_error for NaN or positive log p. The same for weights that are not positive or
// sum to more than 1 (plus rounding).
std::vector<double> weighted_holm(std::span<const WeightedLogP> entries);

}  // namespace assay::stats
