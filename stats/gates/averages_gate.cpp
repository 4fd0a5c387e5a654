#include "stats/gates/averages_gate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/basics/check.h"
#include "stats/basics/moments.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double false_red_of_averages = 1e-7;
constexpr double false_amber_of_averages = 0.01;
constexpr std::size_t fewest_means = 16;

/// Means of values that stand apart, so that neighbours that depend on each other do not meet.
std::vector<double> means_of(std::span<const double> values, std::size_t each) {
  const std::size_t groups = values.size() / each;
  std::vector<double> means;
  for (std::size_t group = 0; group < groups; ++group) {
    double sum = 0;
    for (std::size_t k = 0; k < each; ++k) sum += values[group + k * groups];
    means.push_back(sum / static_cast<double>(each));
  }
  return means;
}

/// Phi^-1 of the ranks, the mean rank for equal values.
std::vector<double> normal_scores(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  std::vector<double> scores;
  for (const double value : values) {
    const auto [first, last] = std::ranges::equal_range(sorted, value);
    const auto below = static_cast<double>(first - sorted.begin());
    const auto equal = static_cast<double>(last - first);
    const double rank = (below + equal / 2) / static_cast<double>(values.size());
    scores.push_back(normal_quantile({Tail::lower, std::log(rank)}));
  }
  return scores;
}

/// |z| of the sum of the first scores, in a random order of all.
double deviation_of_sum(std::span<const double> scores, std::size_t first) {
  Moments all;
  for (const double score : scores) all.add(score);
  double sum = 0;
  for (const double score : scores.first(first)) sum += score - all.mean;
  const auto n = static_cast<double>(scores.size());
  const auto k = static_cast<double>(first);
  const double variance = k * (n - k) / (n * (n - 1)) * all.m2;
  return variance > 0 ? std::abs(sum) / std::sqrt(variance) : 0;
}

}  // namespace

Gate averages_gate(std::span<const double> values, std::span<const double> means,
                   std::size_t each) {
  check::at_least({"averages_gate", "each"}, each, 1);
  for (const double value : values) check::finite({"averages_gate", "value"}, value);
  for (const double mean : means) check::finite({"averages_gate", "mean"}, mean);
  std::vector<double> pooled = means_of(values, each);
  const std::size_t groups = pooled.size();
  const auto limit = [](double chance) { return upper_normal_quantile(chance / 4); };
  Gate gate{.name = "place and spread of means against those of primaries",
            .limit = limit(false_red_of_averages)};
  if (std::min(groups, means.size()) < fewest_means) return gate;
  pooled.insert(pooled.end(), means.begin(), means.end());
  std::vector<double> scores = normal_scores(pooled);
  gate.value = deviation_of_sum(scores, groups);
  for (double& score : scores) score *= score;
  gate.value = std::max(gate.value, deviation_of_sum(scores, groups));
  gate.low = gate.value;
  if (gate.value > gate.limit)
    gate.state = GateState::red;
  else if (gate.value > limit(false_amber_of_averages))
    gate.state = GateState::amber;
  return gate;
}

}  // namespace assay::stats
