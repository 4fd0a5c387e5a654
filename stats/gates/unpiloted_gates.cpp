#include "stats/gates/unpiloted_gates.h"

#include <algorithm>
#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"

namespace assay::stats {
namespace {

constexpr double least_values = 50;
constexpr double values_a_cube = 6;
// Above it a sample's skewness is too uncertain to correct by.
constexpr double skewness_of_mean = 0.15;
constexpr double skewness_times_critical = 0.4;
constexpr double false_red_without_pilot = 5e-5;

// One sample's share in the skewness of a contrast, and the share that normal data would have.
struct SkewnessShare {
  double value = 0;
  double allowance = 0;
};

SkewnessShare part_of(const Moments& x, double variance_share) {
  if (x.m2 == 0) return {};
  const double n = static_cast<double>(x.count);
  const double weight = variance_share * std::sqrt(variance_share / n);
  return {weight * x.skewness(), weight * normal_skewness_quantile(n, false_red_without_pilot)};
}

Gate gate_of(const SkewnessShare& first, const SkewnessShare& second, double critical_value) {
  check::positive({"unpiloted_skewness_gate", "critical_value"}, critical_value);
  Gate gate{.name = "skewness of the mean", .value = std::abs(first.value - second.value)};
  gate.low = gate.value;
  gate.limit = std::max(std::min(skewness_of_mean, skewness_times_critical / critical_value),
                        std::hypot(first.allowance, second.allowance));
  gate.state = gate.value <= gate.limit ? GateState::green : GateState::red;
  return gate;
}

}  // namespace

std::uint64_t fewest_unpiloted(double critical_value, double variance_share) {
  check::positive({"fewest_unpiloted", "critical_value"}, critical_value);
  check::unit({"fewest_unpiloted", "variance_share"}, variance_share);
  const double needed = std::max(least_values, values_a_cube * std::pow(critical_value, 3)) *
                        std::pow(variance_share, 3);
  return static_cast<std::uint64_t>(std::max(2.0, std::ceil(needed)));
}

Gate unpiloted_count_gate(const Moments& x, double critical_value, double variance_share) {
  const auto fewest = static_cast<double>(fewest_unpiloted(critical_value, variance_share));
  const auto count = static_cast<double>(x.count);
  return {.name = "count",
          .value = count,
          .low = count,
          .limit = fewest,
          .state = count < fewest ? GateState::red : GateState::green};
}

Gate unpiloted_skewness_gate(const Moments& x, double critical_value) {
  check::at_least({"unpiloted_skewness_gate", "count"}, x.count, 2);
  if (x.m2 == 0) throw ZeroVariance("unpiloted_skewness_gate: zero variance");
  return gate_of(part_of(x, 1), {}, critical_value);
}

Gate unpiloted_skewness_gate(const Moments& x, const Moments& y, double scale,
                             double critical_value) {
  check::finite({"unpiloted_skewness_gate", "scale"}, scale);
  const double vx = x.variance() / static_cast<double>(x.count);
  const double vy = scale * scale * y.variance() / static_cast<double>(y.count);
  if (vx + vy == 0) throw ZeroVariance("unpiloted_skewness_gate: zero variance in both samples");
  SkewnessShare of_y = part_of(y, vy / (vx + vy));
  of_y.value = std::copysign(of_y.value, scale * of_y.value);
  return gate_of(part_of(x, vx / (vx + vy)), of_y, critical_value);
}

}  // namespace assay::stats
