#include "stats/cells/chi_square_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "stats/basics/check.h"
#include "stats/tails/special.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

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

std::uint64_t impossible_observations(const CellCounts& counts) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < counts.probability.size(); ++i) {
    if (counts.probability[i] == 0) total += counts.observed[i];
  }
  return total;
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
  fit.observations =
      std::accumulate(counts.observed.begin(), counts.observed.end(), std::uint64_t{0});
  check::at_least({"chi_square_fit", "observations"}, fit.observations, 1);
  const double n = static_cast<double>(fit.observations);
  fit.cells = pooled(counts, n, options.minimum_expected);
  check::at_least({"chi_square_fit", "pooled cells"}, fit.cells.size(), 2);
  fit.impossible = impossible_observations(counts);
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

Interval chi_square_fit_interval(const ChiSquareFit& fit, double confidence) {
  const CellEffect cells = cell_effect(fit);
  const double start =
      std::sqrt(std::max(0.0, cells.squared()) + 1 / static_cast<double>(fit.observations));
  return effect_interval([&](double w) { return effect_tails(fit, cells, w); }, start, confidence);
}

Evidence chi_square_evidence(const ChiSquareFit& fit) {
  return {.estimate = fit.effect,
          .at =
              [fit](double w) {
                return w == 0 ? fit.test : chi_square_fit_effect(fit, std::max(0.0, w));
              },
          .interval = [fit](double confidence) { return chi_square_fit_interval(fit, confidence); },
          .quantity = effect_over_cells,
          .distance = true};
}

}  // namespace assay::stats
