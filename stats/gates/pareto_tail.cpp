#include "stats/gates/pareto_tail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr std::size_t fewest_exceedances = 5;
constexpr double gate_confidence = 0.9999;

void check_ascending(const char* function, std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    check::finite({function, "value"}, values[i]);
    if (i > 0 && values[i] < values[i - 1]) {
      check::fail({function, "value"}, values[i], "in ascending order");
    }
  }
}

double mean_log(std::span<const double> y, double theta) {
  double sum = 0;
  for (const double value : y) sum += std::log1p(-theta * value);
  return sum / static_cast<double>(y.size());
}

std::vector<double> theta_grid(std::span<const double> y) {
  const double n = static_cast<double>(y.size());
  const double quartile = y[static_cast<std::size_t>(n / 4 + 0.5) - 1];
  const auto size = 30 + static_cast<std::size_t>(std::sqrt(n));
  std::vector<double> grid(size);
  for (std::size_t j = 0; j < size; ++j) {
    const double place = static_cast<double>(size) / (static_cast<double>(j) + 0.5);
    grid[j] = 1 / y.back() + (1 - std::sqrt(place)) / (3 * quartile);
  }
  return grid;
}

double log_likelihood(std::span<const double> y, double theta) {
  const double k = mean_log(y, theta);
  // At theta = 0 the law is exponential: -theta / k -> 1 / mean.
  double mean = 0;
  for (const double value : y) mean += value / static_cast<double>(y.size());
  const double rate = theta == 0 ? 1 / mean : -theta / k;
  return static_cast<double>(y.size()) * (std::log(rate) - k - 1);
}

double posterior_mean(std::span<const double> y) {
  const std::vector<double> grid = theta_grid(y);
  std::vector<double> log_weight;
  for (const double theta : grid) log_weight.push_back(log_likelihood(y, theta));
  const double largest = *std::max_element(log_weight.begin(), log_weight.end());
  double sum = 0;
  double total = 0;
  for (std::size_t j = 0; j < grid.size(); ++j) {
    const double weight = std::exp(log_weight[j] - largest);
    sum += weight * grid[j];
    total += weight;
  }
  return sum / total;
}

// Excess of the values over the smallest, ascending. Nothing if all are equal.
std::vector<double> exceedances_of(std::span<const double> tail) {
  std::vector<double> exceedances;
  for (const double value : tail) {
    if (value > tail.front()) exceedances.push_back(value - tail.front());
  }
  return exceedances;
}

std::vector<double> tail_exceedances(std::span<const double> largest, std::uint64_t count) {
  check::at_least({"pareto_tail", "count"}, count, fewest_exceedances);
  const std::size_t needed = pareto_tail_size(count) + 1;
  check::at_least({"pareto_tail", "number of largest values"}, largest.size(), needed);
  check_ascending("pareto_tail", largest);
  return exceedances_of(largest.last(needed));
}

ParetoTail tail_of(const std::vector<double>& exceedances, double confidence) {
  const GeneralisedPareto fit = fit_generalised_pareto(exceedances);
  const double z = normal_quantile({Tail::upper, std::log1p(-confidence)});
  const double error = z / std::sqrt(static_cast<double>(exceedances.size()));
  return {fit.shape, (std::min(fit.shape, fit.raw_shape) - error) / (1 + error),
          exceedances.size()};
}

}  // namespace

GeneralisedPareto fit_generalised_pareto(std::span<const double> exceedances) {
  check::at_least({"fit_generalised_pareto", "exceedances"}, exceedances.size(),
                  fewest_exceedances);
  check_ascending("fit_generalised_pareto", exceedances);
  check::positive({"fit_generalised_pareto", "exceedance"}, exceedances.front());
  // On the scale of the largest, so that neither 1 / y nor its powers overflow.
  std::vector<double> y(exceedances.begin(), exceedances.end());
  const double unit = y.back();
  for (double& value : y) value = std::max(value / unit, std::numeric_limits<double>::min());
  const double theta = posterior_mean(y);
  const double raw = mean_log(y, theta);
  const double n = static_cast<double>(y.size());
  return {(raw * n + 5) / (n + 10), raw, -raw / theta * unit};
}

std::size_t pareto_tail_size(std::uint64_t n) {
  const double size = static_cast<double>(n);
  return static_cast<std::size_t>(std::ceil(std::min(size / 5, 3 * std::sqrt(size))));
}

ParetoTail pareto_tail(std::span<const double> largest, std::uint64_t count, double confidence) {
  check::inside_unit({"pareto_tail", "confidence"}, confidence);
  return tail_of(tail_exceedances(largest, count), confidence);
}

double pareto_limit(TailClaim claim, std::uint64_t count) {
  check::at_least({"pareto_limit", "count"}, count, 2);
  const double by_sums = std::min(0.7, 1 - 1 / std::log10(static_cast<double>(count)));
  switch (claim) {
    case TailClaim::mean:
      return std::min(0.5, by_sums);
    case TailClaim::variance:
      return std::min(0.25, by_sums);
    case TailClaim::any_mean:
      return by_sums;
  }
  check::fail({"pareto_limit", "claim"}, static_cast<int>(claim), "one of the three");
}

Gate pareto_gate(std::span<const double> largest, std::uint64_t count, TailClaim claim) {
  Gate gate{"tail index", 0, 0, pareto_limit(claim, count), GateState::green};
  const std::vector<double> exceedances = tail_exceedances(largest, count);
  if (exceedances.size() < fewest_exceedances) return gate;
  const ParetoTail tail = tail_of(exceedances, gate_confidence);
  gate.value = tail.shape;
  gate.low = tail.low;
  if (gate.low > gate.limit)
    gate.state = GateState::red;
  else if (gate.value > gate.limit)
    gate.state = GateState::amber;
  return gate;
}

}  // namespace assay::stats
