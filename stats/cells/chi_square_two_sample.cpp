#include "stats/cells/chi_square_two_sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

void check_counts(const TwoSampleCounts& counts, double minimum_expected) {
  check::at_least({"chi_square_two_sample", "cells"}, counts.x.size(), 1);
  if (counts.x.size() != counts.y.size()) {
    check::fail({"chi_square_two_sample", "number of counts of y"}, counts.y.size(),
                "that of x, " + std::to_string(counts.x.size()));
  }
  check::non_negative({"chi_square_two_sample", "minimum_expected"}, minimum_expected);
  check::at_least({"chi_square_two_sample", "values of x"}, total(counts.x), 1);
  check::at_least({"chi_square_two_sample", "values of y"}, total(counts.y), 1);
}

void absorb(PooledPair& into, const PooledPair& from) {
  into.x += from.x;
  into.y += from.y;
  into.members.insert(into.members.end(), from.members.begin(), from.members.end());
}

/// Pools neighbours until the smaller sample expects enough of them. The rest at the end joins the
/// last pool.
std::vector<PooledPair> pooled(const TwoSampleCounts& counts, double enough) {
  std::vector<PooledPair> pools;
  PooledPair open;
  for (std::size_t i = 0; i < counts.x.size(); ++i) {
    if (counts.x[i] + counts.y[i] == 0) continue;
    absorb(open, {.x = counts.x[i], .y = counts.y[i], .members = {i}});
    if (static_cast<double>(open.x + open.y) < enough) continue;
    pools.push_back(std::move(open));
    open = {};
  }
  if (open.members.empty()) return pools;
  if (pools.empty()) {
    pools.push_back(std::move(open));
  } else {
    absorb(pools.back(), open);
  }
  return pools;
}

}  // namespace

ChiSquareTwoSample chi_square_two_sample(const TwoSampleCounts& counts, double minimum_expected) {
  check_counts(counts, minimum_expected);
  const double m = static_cast<double>(total(counts.x));
  const double n = static_cast<double>(total(counts.y));
  ChiSquareTwoSample result;
  result.cells = pooled(counts, minimum_expected * (m + n) / std::min(m, n));
  check::at_least({"chi_square_two_sample", "pooled cells"}, result.cells.size(), 2);
  double sum = 0;
  for (PooledPair& cell : result.cells) {
    const double a = static_cast<double>(cell.x);
    const double b = static_cast<double>(cell.y);
    const double difference = std::sqrt(n / m) * a - std::sqrt(m / n) * b;
    cell.part = difference * difference / (a + b);
    sum += cell.part;
  }
  result.statistic = {.value = sum,
                      .degrees_of_freedom = static_cast<double>(result.cells.size() - 1),
                      .observations = m * n / (m + n)};
  const LogTails tails = chi_square_tails(sum, result.statistic.degrees_of_freedom);
  result.test = {sum,
                 {"chi-square", {result.statistic.degrees_of_freedom}},
                 tails.lower,
                 tails.upper,
                 Exactness::asymptotic};
  return result;
}

}  // namespace assay::stats
