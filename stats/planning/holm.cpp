#include "stats/planning/holm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "stats/basics/check.h"

namespace assay::stats {
namespace {

// Rounding that a sum of weights such as 1/m + … + 1/m may carry.
constexpr double rounding_of_weights = 1e-9;

double checked_total(std::span<const WeightedLogP> entries) {
  double total = 0;
  for (const WeightedLogP& entry : entries) {
    check::log_probability({"weighted_holm", "log_p"}, entry.log_p);
    check::positive({"weighted_holm", "weight"}, entry.weight);
    total += entry.weight;
  }
  if (total > 1 + rounding_of_weights)
    check::fail({"weighted_holm", "sum of weights"}, total, "at most 1");
  return total;
}

}  // namespace

std::vector<double> weighted_holm(std::span<const WeightedLogP> entries) {
  const double total = checked_total(entries);
  const auto share = [&](std::size_t i) { return entries[i].log_p - std::log(entries[i].weight); };
  std::vector<std::size_t> order(entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, share);
  std::vector<double> adjusted(entries.size());
  double running = -std::numeric_limits<double>::infinity();
  double remaining = std::max(total, 1.0);
  for (const std::size_t index : order) {
    // Rounding in `remaining` must not undercut the entry's own weight.
    const double pool = std::clamp(remaining, entries[index].weight, 1.0);
    running = std::max(running, share(index) + std::log(pool));
    adjusted[index] = std::min(running, 0.0);
    remaining -= entries[index].weight;
  }
  return adjusted;
}

}  // namespace assay::stats
