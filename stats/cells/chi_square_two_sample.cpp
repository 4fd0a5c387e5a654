#include "stats/cells/chi_square_two_sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/cells/cell_effect.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double fewest_expected = 20;

std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

void check_counts(const TwoSampleCounts& counts) {
  check::at_least({"chi_square_two_sample", "cells"}, counts.x.size(), 1);
  if (counts.x.size() != counts.y.size()) {
    check::fail({"chi_square_two_sample", "number of counts of y"}, counts.y.size(),
                "that of x, " + std::to_string(counts.x.size()));
  }
  check::at_least({"chi_square_two_sample", "values of x"}, total(counts.x), 1);
  check::at_least({"chi_square_two_sample", "values of y"}, total(counts.y), 1);
}

void absorb(PooledPair& into, const PooledPair& from) {
  into.x += from.x;
  into.y += from.y;
  into.members.insert(into.members.end(), from.members.begin(), from.members.end());
}

// Pools neighbours until the smaller sample expects enough of them. The rest at the end joins the
// last pool.
std::vector<PooledPair> pooled(const TwoSampleCounts& counts, double enough) {
  std::vector<PooledPair> pools;
  PooledPair open;
  for (std::size_t i = 0; i < counts.x.size(); ++i) {
    if (counts.x[i] + counts.y[i] == 0) continue;
    absorb(open, {.x = counts.x[i], .y = counts.y[i], .members = {i}});
    if (static_cast<double>(open.x + open.y) < enough) continue;
    pools.push_back(std::exchange(open, {}));
  }
  if (open.members.empty()) return pools;
  if (pools.empty()) pools.emplace_back();
  absorb(pools.back(), open);
  return pools;
}

LogTails effect_tails(const ChiSquareStatistic& statistic, double effect) {
  return noncentral_chi_square_tails(
      statistic.value, {statistic.degrees_of_freedom, statistic.observations * effect * effect});
}

using Points = std::span<PlanePoint>;

/// Borders that cut sorted values into about equal parts. None is the smallest value, and none
/// occurs twice.
std::vector<double> borders(Points sorted, std::size_t parts, double PlanePoint::*coordinate) {
  std::vector<double> all;
  double last = sorted.front().*coordinate;
  for (std::size_t k = 1; k < parts; ++k) {
    const double value = sorted[k * sorted.size() / parts].*coordinate;
    if (value > last) all.push_back(value);
    last = value;
  }
  return all;
}

}  // namespace

ChiSquareTwoSample chi_square_two_sample(const TwoSampleCounts& counts) {
  check_counts(counts);
  const double m = static_cast<double>(total(counts.x));
  const double n = static_cast<double>(total(counts.y));
  ChiSquareTwoSample result;
  result.cells = pooled(counts, fewest_expected * (m + n) / std::min(m, n));
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
  const double degrees = result.statistic.degrees_of_freedom;
  result.test = by_tails(sum, {"chi-square", {degrees}}, chi_square_tails(sum, degrees));
  return result;
}

double ChiSquareStatistic::effect() const {
  return std::sqrt(std::max(0.0, value - degrees_of_freedom) / observations);
}

TestResult chi_square_effect(const ChiSquareStatistic& statistic, double null_effect) {
  check::non_negative({"chi_square_effect", "null_effect"}, null_effect);
  const double noncentrality = statistic.observations * null_effect * null_effect;
  return by_tails(statistic.value,
                  {"noncentral-chi-square", {statistic.degrees_of_freedom, noncentrality}},
                  effect_tails(statistic, null_effect));
}

Interval chi_square_effect_interval(const ChiSquareStatistic& statistic, double confidence) {
  const double start = statistic.effect() + 1 / std::sqrt(statistic.observations);
  return effect_interval([&](double w) { return effect_tails(statistic, w); }, start, confidence);
}

std::size_t SampledCells::index(PlanePoint point) const {
  const std::size_t band = count_up_to(band_borders, point.first);
  return before[band] + count_up_to(cut_borders[band], point.second);
}

SampledCells sampled_cells(std::vector<PlanePoint> points, CellNumbers numbers) {
  check::at_least({"sampled_cells", "points"}, points.size(), 1);
  check::at_least({"sampled_cells", "bands"}, numbers.bands, 1);
  check::at_least({"sampled_cells", "cuts"}, numbers.cuts, 1);
  for (const PlanePoint& point : points) {
    check::finite({"sampled_cells", "first coordinate"}, point.first);
    check::finite({"sampled_cells", "second coordinate"}, point.second);
  }
  std::ranges::sort(points, {}, &PlanePoint::first);
  SampledCells cells{.band_borders = borders(points, numbers.bands, &PlanePoint::first)};
  std::size_t behind = 0;
  auto begin = points.begin();
  for (std::size_t band = 0; band <= cells.band_borders.size(); ++band) {
    const auto end = band == cells.band_borders.size()
                         ? points.end()
                         : std::ranges::lower_bound(begin, points.end(), cells.band_borders[band],
                                                    {}, &PlanePoint::first);
    std::ranges::sort(begin, end, {}, &PlanePoint::second);
    cells.cut_borders.push_back(borders(Points(begin, end), numbers.cuts, &PlanePoint::second));
    cells.before.push_back(behind);
    behind += cells.cut_borders.back().size() + 1;
    begin = end;
  }
  return cells;
}

Evidence chi_square_evidence(const ChiSquareTwoSample& fit) {
  return {.estimate = fit.statistic.effect(),
          .at = [fit](double w) { return w <= 0 ? fit.test : chi_square_effect(fit.statistic, w); },
          .interval =
              [statistic = fit.statistic](double confidence) {
                return chi_square_effect_interval(statistic, confidence);
              },
          .quantity = effect_over_cells,
          .distance = true};
}

}  // namespace assay::stats
