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

double checked_total(const char* function, std::span<const WeightedLogP> entries) {
  double total = 0;
  for (const WeightedLogP& entry : entries) {
    check::log_probability({function, "log_p"}, entry.log_p);
    check::positive({function, "weight"}, entry.weight);
    total += entry.weight;
  }
  if (total > 1 + rounding_of_weights)
    check::fail({function, "sum of weights"}, total, "at most 1");
  return total;
}

template <class Key>
std::vector<std::size_t> ascending(std::size_t size, const Key& key) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

}  // namespace

std::vector<double> holm(std::span<const double> log_p) {
  for (const double value : log_p) check::log_probability({"holm", "log_p"}, value);
  const auto order = ascending(log_p.size(), [&](std::size_t i) { return log_p[i]; });
  std::vector<double> adjusted(log_p.size());
  double running = -std::numeric_limits<double>::infinity();
  double remaining = static_cast<double>(log_p.size());
  for (const std::size_t index : order) {
    running = std::max(running, log_p[index] + std::log(remaining));
    adjusted[index] = std::min(running, 0.0);
    remaining -= 1;
  }
  return adjusted;
}

std::vector<double> weighted_holm(std::span<const WeightedLogP> entries) {
  const double total = checked_total("weighted_holm", entries);
  const auto share = [&](std::size_t i) { return entries[i].log_p - std::log(entries[i].weight); };
  const auto order = ascending(entries.size(), share);
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
