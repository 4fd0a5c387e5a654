#include "harness/plan/exact_size.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/plan/planned_rates.h"
#include "stats/means/power_exact.h"

namespace assay::harness {
namespace {

// Barnard's maximum over the nuisance probability costs at most this (stats/means/two_valued.h).
constexpr double two_sample_cost = 1.4;

/// Sides of the reference where an effect is to be found.
std::vector<int> sides_of(Relation relation) {
  switch (relation) {
    case Relation::at_most:
    case Relation::greater:
      return {1};
    case Relation::at_least:
    case Relation::less:
      return {-1};
    case Relation::equal:
    case Relation::within:
      break;
  }
  return {1, -1};
}

bool is_quoted(const Question& question, const Plan& plan, const PlannedChannel& channel) {
  return plan.method.is.plans && question.kind == QuestionKind::mean_of_one &&
         channel.regions.relation != Relation::within && std::isfinite(channel.range.low) &&
         std::isfinite(channel.range.high) && channel.range.low < channel.range.high;
}

stats::ExactMeanPlan plan_of(const PlannedChannel& channel, const stats::ErrorRates& rates) {
  return {.range = channel.range,
          .null_mean = channel.null_value,
          .standard_deviation = channel.standard_deviation,
          .allow = channel.regions.proof() ? 0 : channel.regions.allow * channel.unit,
          .rates = rates};
}

}  // namespace

std::optional<std::uint64_t> exact_secondaries(const Question& question, const Plan& plan,
                                               const PlannedChannel& channel,
                                               const stats::ErrorRates& rates) {
  const double detect = channel.regions.detect.value_or(0) * channel.unit;
  if (question.of_two()) {
    const auto welch = stats::welch_sample_size({.standard_deviation_x = channel.standard_deviation,
                                                 .standard_deviation_y = channel.other_deviation,
                                                 .allow = channel.regions.allow * channel.unit,
                                                 .rates = rates},
                                                detect);
    if (!welch) return std::nullopt;
    return static_cast<std::uint64_t>(std::ceil(two_sample_cost * static_cast<double>(*welch)));
  }
  std::uint64_t most = 0;
  for (const int side : sides_of(channel.regions.relation)) {
    const auto count =
        stats::exact_sample_size(*plan.method.is.plans, plan_of(channel, rates), side * detect);
    if (!count) return std::nullopt;
    most = std::max(most, *count);
  }
  return most;
}

std::optional<std::uint64_t> exact_equivalence_secondaries(const Question& question,
                                                           const Plan& plan,
                                                           const PlannedChannel& channel,
                                                           const ErrorShare& share) {
  // At each margin theta = 0 is the effect to be found, with half of the misses.
  const stats::ErrorRates rates = planned_rates(share, channel.regions);
  PlannedChannel at_margin = channel;
  at_margin.regions.detect = channel.regions.within;
  at_margin.regions.allow = 0;
  if (question.of_two()) return exact_secondaries(question, plan, at_margin, rates);
  const double margin = channel.regions.within * channel.unit;
  std::uint64_t most = 0;
  for (const int side : {1, -1}) {
    at_margin.null_value = channel.null_value + side * margin;
    const auto count =
        stats::exact_sample_size(*plan.method.is.plans, plan_of(at_margin, rates), -side * margin);
    if (!count) return std::nullopt;
    most = std::max(most, *count);
  }
  return most;
}

std::optional<double> exact_detectable_effect(const Question& question, const TestSize& size,
                                              const Plan& plan, const PlannedChannel& channel,
                                              const stats::ErrorRates& rates) {
  if (!is_quoted(question, plan, channel)) return std::nullopt;
  double most = 0;
  for (const int side : sides_of(channel.regions.relation)) {
    const auto found = stats::exact_detectable(*plan.method.is.plans, plan_of(channel, rates),
                                               size.secondaries, side);
    // The range ends before any such effect on this side.
    if (!found) return std::nullopt;
    most = std::max(most, *found);
  }
  return most / channel.unit;
}

bool exact_finds_nothing(const Question& question, const TestSize& size, const Plan& plan,
                         const PlannedChannel& channel, const stats::ErrorRates& rates) {
  if (!is_quoted(question, plan, channel)) return false;
  return std::ranges::none_of(sides_of(channel.regions.relation), [&](int side) {
    return stats::exact_detectable(*plan.method.is.plans, plan_of(channel, rates), size.secondaries,
                                   side)
        .has_value();
  });
}

std::optional<double> exact_power_at(const Question& question, const TestSize& size,
                                     const Plan& plan, const PlannedChannel& channel,
                                     const stats::ErrorRates& rates, double effect) {
  if (!is_quoted(question, plan, channel) || effect == 0) return std::nullopt;
  const stats::ExactMeanPlan exact = plan_of(channel, rates);
  double least = 1;
  for (const int side : sides_of(channel.regions.relation)) {
    const double theta = side * effect * channel.unit;
    const double power = *plan.method.is.plans == stats::ExactMethod::binomial
                             ? stats::binomial_power(exact, size.secondaries, theta)
                             : stats::bounded_power(exact, size.secondaries, theta);
    least = std::min(least, power);
  }
  return least;
}

}  // namespace assay::harness
