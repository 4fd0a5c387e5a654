#include "stats/planning/looks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/planning/planning.h"

namespace assay::stats {
namespace {

// Weights such as 1/3 + 1/3 + 1/3 may miss 1 by rounding.
constexpr double rounding = 1e-12;

void check_schedule(const char* function, const LookSchedule& schedule) {
  check::at_least({function, "looks"}, schedule.sizes.size(), 1);
  if (schedule.weights.size() != schedule.sizes.size()) {
    check::fail({function, "number of weights"}, schedule.weights.size(), "the number of looks");
  }
  const auto out_of_order = std::adjacent_find(schedule.sizes.begin(), schedule.sizes.end(),
                                               [](auto a, auto b) { return a >= b; });
  if (out_of_order != schedule.sizes.end()) {
    check::fail({function, "size"}, *out_of_order, "below the next look's size");
  }
  for (const double weight : schedule.weights) check::positive({function, "weight"}, weight);
  const double sum = std::accumulate(schedule.weights.begin(), schedule.weights.end(), 0.0);
  if (sum > 1 + rounding) check::fail({function, "sum of weights"}, sum, "at most 1");
}

void check_taken(const char* function, const LookSchedule& schedule, std::size_t taken) {
  check_schedule(function, schedule);
  check::at_least({function, "looks taken"}, taken, 1);
  if (taken > schedule.sizes.size()) {
    check::fail({function, "looks taken"}, taken, "at most the number scheduled");
  }
}

std::size_t number_of_looks(LookRange range, double growth) {
  if (range.first == range.last) return 1;
  const double span = std::log(static_cast<double>(range.last) / static_cast<double>(range.first));
  // 1024 = 2^10 is ten doublings, although the logarithms' quotient may round above ten.
  return 1 + static_cast<std::size_t>(std::ceil(span / std::log(growth) * (1 - rounding)));
}

std::uint64_t size_at(LookRange range, double fraction) {
  const double ratio = static_cast<double>(range.last) / static_cast<double>(range.first);
  return static_cast<std::uint64_t>(
      std::round(static_cast<double>(range.first) * std::pow(ratio, fraction)));
}

}  // namespace

LookSchedule geometric_looks(LookRange range, double growth) {
  check::at_least({"geometric_looks", "first"}, range.first, 1);
  check::at_least({"geometric_looks", "last"}, range.last, range.first);
  if (!(growth > 1) || std::isinf(growth)) {
    check::fail({"geometric_looks", "growth"}, growth, "finite and above 1");
  }
  const std::size_t looks = number_of_looks(range, growth);
  LookSchedule schedule;
  for (std::size_t k = 0; k + 1 < looks; ++k) {
    const auto size = size_at(range, static_cast<double>(k) / static_cast<double>(looks - 1));
    if (size >= range.last) break;
    if (schedule.sizes.empty() || size > schedule.sizes.back()) schedule.sizes.push_back(size);
  }
  schedule.sizes.push_back(range.last);
  schedule.weights.assign(schedule.sizes.size(), 1 / static_cast<double>(schedule.sizes.size()));
  return schedule;
}

double log_p_over_looks(const LookSchedule& schedule, std::span<const double> log_p) {
  check_taken("log_p_over_looks", schedule, log_p.size());
  double smallest = 0;
  for (std::size_t k = 0; k < log_p.size(); ++k) {
    check::log_probability({"log_p_over_looks", "log p"}, log_p[k]);
    smallest = std::min(smallest, log_p[k] - std::log(schedule.weights[k]));
  }
  return smallest;
}

}  // namespace assay::stats
