#include "stats/cells/chi_square.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

// The data's direction is stretched at most this much to the null effect.
constexpr double most_stretched = 2;

constexpr const char* effect_over_cells = "effect size w over the cells";

double variance_of(Noncentral law) { return 2 * (law.degrees + 2 * law.noncentrality); }

}  // namespace

CellEffect::CellEffect(std::span<const PooledCell> cells, std::uint64_t observations)
    : n_(static_cast<double>(observations)), cells_(static_cast<double>(cells.size())) {
  check::at_least({"CellEffect", "observations"}, observations, fewest_observations);
  for (const PooledCell& cell : cells) {
    const double p = cell.expected / n_;
    const double count = static_cast<double>(cell.observed);
    const double first = count / n_ / p;
    const double second = first * ((count - 1) / (n_ - 1) / p);
    const double third = second * ((count - 2) / (n_ - 2) / p);
    const double fourth = third * ((count - 3) / (n_ - 3) / p);
    squared_ += p * (second - 2 * first + 1);
    third_ += p * (third - 3 * second + 3 * first - 1);
    fourth_ += p * (fourth - 4 * third + 6 * second - 4 * first + 1);
    sum_ += first - 1;
    sum_squares_ += second - 2 * first + 1;
  }
}

struct CellEffect::AtNull {
  double variance;  // Variance of U.
  double third;     // Third cumulant of n U.
};

CellEffect::AtNull CellEffect::at_null(double null_effect) const {
  const double squared = null_effect * null_effect;
  const double effect = std::max(std::sqrt(std::max(0.0, squared_)), null_effect / most_stretched);
  const double stretch = effect > 0 ? null_effect / effect : 0;
  const double third = third_ * std::pow(stretch, 3);
  const double fourth = std::max(0.0, fourth_) * std::pow(stretch, 4);
  const double linear = std::max(squared, squared + third - squared * squared);
  const double sum = cells_ + 2 * stretch * sum_ + stretch * stretch * sum_squares_;
  const double quadratic = std::max(cells_ - 1, sum - (1 + squared) * (1 + squared));
  const double pairs = n_ * (n_ - 1);
  const double excess = std::max(0.0, n_ * (56 * third + 32 * fourth));
  return {.variance = 4 * (n_ - 2) / pairs * linear + 2 / pairs * quadratic,
          .third = 8 * (cells_ - 1 + 3 * n_ * squared) + excess};
}

// U, moved so that it is as many standard deviations from that law's mean as from its own.
double CellEffect::moved(const AtNull& law, double null_effect, Noncentral to) const {
  const double z = (squared_ - null_effect * null_effect) / std::sqrt(law.variance);
  return std::max(0.0, to.degrees + to.noncentrality + z * std::sqrt(variance_of(to)));
}

double CellEffect::statistic(double null_effect) const {
  return moved(at_null(null_effect), null_effect, {cells_ - 1, n_ * null_effect * null_effect});
}

LogTails CellEffect::tails(double null_effect) const {
  const AtNull law = at_null(null_effect);
  const Noncentral plain{cells_ - 1, n_ * null_effect * null_effect};
  const double skewness =
      8 * (plain.degrees + 3 * plain.noncentrality) / std::pow(variance_of(plain), 1.5);
  const double of_data = law.third / std::pow(n_ * n_ * law.variance, 1.5);
  const double share = of_data > skewness ? std::pow(skewness / of_data, 2) : 1;
  const Noncentral skew{share * plain.degrees, share * plain.noncentrality};
  return {
      .lower = noncentral_chi_square_tails(moved(law, null_effect, plain), plain).lower,
      .upper = noncentral_chi_square_tails(moved(law, null_effect, skew), skew).upper,
  };
}

namespace {

std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

void check_cells(const CellCounts& counts, const FitOptions& options) {
  check::at_least({"chi_square_fit", "number of cells"}, counts.probability.size(), 1);
  const auto as_many = [&](const char* what, std::size_t size) {
    if (size == counts.probability.size()) return;
    check::fail({"chi_square_fit", what}, size,
                "the number of probabilities, " + std::to_string(counts.probability.size()));
  };
  as_many("number of counts", counts.observed.size());
  if (!counts.error.empty()) as_many("number of errors", counts.error.size());
  for (const double error : counts.error) {
    check::non_negative({"chi_square_fit", "error"}, error);
  }
  check::non_negative({"chi_square_fit", "minimum_expected"}, options.minimum_expected);
  check::non_negative({"chi_square_fit", "probability_tolerance"}, options.probability_tolerance);
  double sum = 0;
  for (const double p : counts.probability) {
    check::non_negative({"chi_square_fit", "probability"}, p);
    sum += p;
  }
  const double rounding = 1e-15 * static_cast<double>(counts.probability.size() + 10);
  if (std::abs(sum - 1) > options.probability_tolerance + rounding) {
    check::fail({"chi_square_fit", "sum of probabilities"}, sum, "1 within the tolerance");
  }
}

void absorb(PooledCell& into, const PooledCell& from) {
  into.observed += from.observed;
  into.expected += from.expected;
  into.members.insert(into.members.end(), from.members.begin(), from.members.end());
}

// Cells of positive probability, large ones alone and small ones gathered.
std::vector<PooledCell> pooled(const CellCounts& counts, double observations, double minimum) {
  std::vector<PooledCell> large;
  std::vector<PooledCell> gathered;
  PooledCell rest;  // The incomplete last pool.
  for (std::size_t i = 0; i < counts.probability.size(); ++i) {
    if (counts.probability[i] == 0) continue;
    const PooledCell cell{counts.observed[i], observations * counts.probability[i], {i}};
    if (cell.expected >= minimum) {
      large.push_back(cell);
      continue;
    }
    absorb(rest, cell);
    if (rest.expected >= minimum) gathered.push_back(std::exchange(rest, {}));
  }
  if (!rest.members.empty()) {
    if (large.empty() && gathered.empty()) gathered.emplace_back();
    absorb(gathered.empty() ? *std::ranges::min_element(large, {}, &PooledCell::expected)
                            : gathered.back(),
           rest);
  }
  large.insert(large.end(), gathered.begin(), gathered.end());
  std::ranges::sort(large, {}, [](const auto& cell) { return cell.members.front(); });
  return large;
}

double pearson(const std::vector<PooledCell>& cells) {
  double sum = 0;
  for (const PooledCell& cell : cells) {
    const double difference = static_cast<double>(cell.observed) - cell.expected;
    sum += difference * difference / cell.expected;
  }
  return sum;
}

double error_effect_of(const ChiSquareFit& fit, const std::vector<double>& error) {
  if (error.empty()) return 0;
  double sum = 0;
  for (const PooledCell& cell : fit.cells) {
    double total = 0;
    for (const std::size_t member : cell.members) total += error[member];
    sum += total * total / cell.expected;
  }
  return std::sqrt(sum * static_cast<double>(fit.observations));
}

CellEffect cell_effect(const ChiSquareFit& fit) { return {fit.cells, fit.observations}; }

double effect_of(const ChiSquareFit& fit) {
  if (fit.observations < CellEffect::fewest_observations) return 0;
  const double squared = std::max(0.0, cell_effect(fit).squared());
  if (fit.impossible == 0) return std::sqrt(squared);
  const double t = fit.probability_tolerance;
  const double share = static_cast<double>(fit.impossible) / static_cast<double>(fit.observations);
  const double beyond = std::max(0.0, share - t);
  return std::sqrt(squared + beyond * beyond / t);
}

/// Tails of the number of impossible observations if w is null_effect by them alone.
LogTails impossible_tails(const ChiSquareFit& fit, double null_effect) {
  const double t = fit.probability_tolerance;
  if (t == 0) return {0, special::lowest_log()};
  const double share = std::min(1.0, t + null_effect * std::sqrt(t));
  return binomial_tails(fit.impossible, {fit.observations, share});
}

/// Tails of two ways to reject, which share the level: by the cells, and by impossible
/// observations.
LogTails with_impossible(const ChiSquareFit& fit, LogTails by_cells, double null_effect) {
  if (fit.impossible == 0) return by_cells;
  const LogTails by_impossible = impossible_tails(fit, null_effect);
  const double upper = std::min(by_cells.upper, by_impossible.upper) + std::log(2.0);
  return {.lower = std::max(by_cells.lower, by_impossible.lower),
          .upper = special::clamp_log(upper)};
}

LogTails effect_tails(const ChiSquareFit& fit, const CellEffect& cells, double null_effect) {
  const double r = fit.error_effect;
  const LogTails by_cells =
      r == 0 ? cells.tails(null_effect)
             : LogTails{.lower = cells.tails(std::max(0.0, null_effect - r)).lower,
                        .upper = cells.tails(null_effect + r).upper};
  return with_impossible(fit, by_cells, null_effect);
}

}  // namespace

ChiSquareFit chi_square_fit(const CellCounts& counts, FitOptions options) {
  check_cells(counts, options);
  ChiSquareFit fit;
  fit.observations = total(counts.observed);
  check::at_least({"chi_square_fit", "observations"}, fit.observations, 1);
  const double n = static_cast<double>(fit.observations);
  fit.cells = pooled(counts, n, options.minimum_expected);
  check::at_least({"chi_square_fit", "pooled cells"}, fit.cells.size(), 2);
  for (std::size_t i = 0; i < counts.probability.size(); ++i) {
    if (counts.probability[i] == 0) fit.impossible += counts.observed[i];
  }
  fit.probability_tolerance = options.probability_tolerance;
  fit.degrees_of_freedom = static_cast<double>(fit.cells.size() - 1);
  fit.error_effect = error_effect_of(fit, counts.error);
  const double statistic = pearson(fit.cells);
  LogTails tails = chi_square_tails(statistic, fit.degrees_of_freedom);
  if (fit.error_effect > 0 && fit.observations >= CellEffect::fewest_observations) {
    tails.upper = std::max(tails.upper, cell_effect(fit).tails(fit.error_effect).upper);
  }
  tails.upper = with_impossible(fit, tails, 0).upper;
  fit.test = by_tails(statistic, {"chi-square", {fit.degrees_of_freedom}}, tails);
  fit.effect = effect_of(fit);
  return fit;
}

TestResult chi_square_fit_effect(const ChiSquareFit& fit, double null_effect) {
  check::non_negative({"chi_square_fit_effect", "null_effect"}, null_effect);
  const CellEffect cells = cell_effect(fit);
  const double n = static_cast<double>(fit.observations);
  return by_tails(
      cells.statistic(null_effect),
      {"noncentral-chi-square", {fit.degrees_of_freedom, n * null_effect * null_effect}},
      effect_tails(fit, cells, null_effect));
}

namespace {

constexpr double fewest_expected = 20;

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
  const Noncentral law{statistic.degrees_of_freedom,
                       statistic.observations * null_effect * null_effect};
  return by_tails(statistic.value, {"noncentral-chi-square", {law.degrees, law.noncentrality}},
                  noncentral_chi_square_tails(statistic.value, law));
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

Evidence chi_square_evidence(const ChiSquareFit& fit) {
  return distance_evidence({.quantity = effect_over_cells,
                            .estimate = fit.effect,
                            .equal = fit.test,
                            .at = [fit](double w) { return chi_square_fit_effect(fit, w); },
                            .start = std::sqrt(std::max(0.0, cell_effect(fit).squared()) +
                                               1 / static_cast<double>(fit.observations))});
}

Evidence chi_square_evidence(const ChiSquareTwoSample& fit) {
  const ChiSquareStatistic& statistic = fit.statistic;
  return distance_evidence({.quantity = effect_over_cells,
                            .estimate = statistic.effect(),
                            .equal = fit.test,
                            .at = [statistic](double w) { return chi_square_effect(statistic, w); },
                            .start = statistic.effect() + 1 / std::sqrt(statistic.observations)});
}

}  // namespace assay::stats
