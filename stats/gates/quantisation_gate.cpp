#include "stats/gates/quantisation_gate.h"

#include <cmath>
#include <limits>

#include "stats/basics/check.h"

namespace assay::stats {
namespace {

constexpr double limit = 0.05;
constexpr double most_steps = 0x1p20;
// In steps. Values written with a fixed number of decimals are off their lattice by rounding.
constexpr double tolerance = 0.01;

double smallest_gap(std::span<const double> sorted) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double gap = sorted[i] - sorted[i - 1];
    if (gap > 0 && gap < smallest) smallest = gap;
  }
  return smallest;
}

bool is_lattice(std::span<const double> sorted) {
  const double gap = smallest_gap(sorted);
  const double range = sorted.back() - sorted.front();
  if (!(range / gap <= most_steps)) return false;
  // The mean step, because one gap alone is known to rounding only.
  const double steps = std::round(range / gap);
  for (const double value : sorted) {
    const double position = (value - sorted.front()) / range * steps;
    if (std::abs(position - std::round(position)) > tolerance) return false;
  }
  return true;
}

double tie_probability(std::span<const double> sorted) {
  const double n = static_cast<double>(sorted.size());
  double pairs = 0;
  double count = 1;
  for (std::size_t i = 1; i <= sorted.size(); ++i) {
    if (i < sorted.size() && sorted[i] == sorted[i - 1]) {
      ++count;
      continue;
    }
    pairs += count * (count - 1);
    count = 1;
  }
  return pairs / (n * (n - 1));
}

}  // namespace

Gate quantisation_gate(std::span<const double> sorted, double level) {
  check::at_least({"quantisation_gate", "count"}, sorted.size(), 2);
  check::inside_unit({"quantisation_gate", "level"}, level);
  check::finite({"quantisation_gate", "smallest value"}, sorted.front());
  check::finite({"quantisation_gate", "largest value"}, sorted.back());
  const double rejected = std::sqrt(std::log(2 / level) / (2 * static_cast<double>(sorted.size())));
  const double ties = is_lattice(sorted) ? tie_probability(sorted) : 0;
  Gate gate{.name = "rounding", .value = ties / (2 * rejected), .limit = limit};
  gate.low = gate.value;
  gate.state = gate.value <= limit ? GateState::green : GateState::red;
  return gate;
}

}  // namespace assay::stats
