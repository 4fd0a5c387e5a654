#include "stats/gates/recurring_values.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "stats/basics/sorted.h"

namespace assay::stats {
namespace {

constexpr double chance_of_triple = 1e-5;

/// Numbers of values in three patterns, whose expectations satisfy (E middle)^2 <= (factor)^2 E
/// below E above.
struct Triple {
  double below;
  double middle;
  double above;
  double factor;
};

double log_likelihood(double count, double share) {
  return count > 0 ? count * std::log(share) : 0;
}

/// ln of the greatest likelihood within the bound over that without it; 0 if within. On the bound
/// the three are as 1, factor b, b^2, with b from the mean of the places 0, 1, 2.
double log_ratio(const Triple& n) {
  const double total = n.below + n.middle + n.above;
  if (n.middle * n.middle <= n.factor * n.factor * n.below * n.above) return 0;
  const double place = (n.middle + 2 * n.above) / total;
  const double a = 2 - place;
  const double half = n.factor * (1 - place) / 2;
  const double b = (std::sqrt(half * half + a * place) - half) / a;
  const double sum = 1 + n.factor * b + b * b;
  return log_likelihood(n.below, total / (n.below * sum)) +
         log_likelihood(n.middle, total * n.factor * b / (n.middle * sum)) +
         log_likelihood(n.above, total * b * b / (n.above * sum));
}

/// The greatest number in the middle whose ratio is not below.
std::size_t greatest_middle(Triple n, double log_chance) {
  std::size_t within = 0;
  auto beyond = static_cast<std::size_t>(n.middle);
  while (beyond - within > 1) {
    const std::size_t tried = within + (beyond - within) / 2;
    n.middle = static_cast<double>(tried);
    (log_ratio(n) < log_chance ? beyond : within) = tried;
  }
  return within;
}

std::vector<double> sorted_stays(std::span<const double> values) {
  std::vector<double> stays(values.begin(), values.end());
  stays.erase(std::unique(stays.begin(), stays.end()), stays.end());
  return sorted(std::move(stays));
}

using Occurrences = std::map<std::size_t, std::size_t>;

Occurrences occurrences_of(const std::vector<double>& sorted) {
  Occurrences occurrences;
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const auto end = std::upper_bound(begin, sorted.end(), *begin);
    ++occurrences[static_cast<std::size_t>(end - begin)];
    begin = end;
  }
  return occurrences;
}

double number(const Occurrences& occurrences, std::size_t times) {
  const auto found = occurrences.find(times);
  return found == occurrences.end() ? 0 : static_cast<double>(found->second);
}

}  // namespace

std::optional<RecurringValues> recurring_values(std::span<const double> values) {
  const std::vector<double> stays = sorted_stays(values);
  const Occurrences occurrences = occurrences_of(stays);
  const auto n = static_cast<double>(stays.size());
  const double log_chance = std::log(chance_of_triple / static_cast<double>(occurrences.size()));
  std::optional<RecurringValues> worst;
  double least = log_chance;
  for (const auto& [times, count] : occurrences) {
    if (times < 2 || times == stays.size()) continue;
    const auto k = static_cast<double>(times);
    const Triple triple{.below = number(occurrences, times - 1),
                        .middle = static_cast<double>(count),
                        .above = number(occurrences, times + 1),
                        .factor = std::sqrt((k + 1) * (n - k + 1) / (k * (n - k)))};
    const double ratio = log_ratio(triple);
    if (!(ratio < least)) continue;
    least = ratio;
    worst = {.times = times, .values = count, .limit = greatest_middle(triple, log_chance)};
  }
  return worst;
}

std::optional<RecurringValues> shared_values(std::span<const double> first,
                                             std::span<const double> second) {
  const std::vector<double> one = sorted_stays(first);
  const std::vector<double> two = sorted_stays(second);
  if (one.size() < 2 || two.size() < 2) return {};
  const auto count = [](const std::vector<double>& in, double value) {
    const auto [begin, end] = std::equal_range(in.begin(), in.end(), value);
    return end - begin;
  };
  const auto n = static_cast<double>(one.size());
  const auto m = static_cast<double>(two.size());
  Triple triple{
      .below = 0, .middle = 0, .above = 0, .factor = 2 * std::sqrt(n * m / ((n - 1) * (m - 1)))};
  for (auto at = one.begin(); at != one.end(); at = std::upper_bound(at, one.end(), *at)) {
    const auto here = count(one, *at);
    const auto there = count(two, *at);
    if (here == 1 && there == 1) ++triple.middle;
    if (here == 2 && there == 0) ++triple.below;
  }
  for (auto at = two.begin(); at != two.end(); at = std::upper_bound(at, two.end(), *at)) {
    if (count(two, *at) == 2 && count(one, *at) == 0) ++triple.above;
  }
  if (!(log_ratio(triple) < std::log(chance_of_triple))) return {};
  return RecurringValues{.times = 1,
                         .values = static_cast<std::size_t>(triple.middle),
                         .limit = greatest_middle(triple, std::log(chance_of_triple))};
}

}  // namespace assay::stats
