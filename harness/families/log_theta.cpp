#include "harness/families/log_theta.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/plan/planned_rates.h"
#include "harness/plan/sample_size.h"
#include "harness/plan/secondaries.h"
#include "stats/planning/power.h"

namespace assay::harness {
namespace {

double allocation(const stats::SampleSizes& sizes) { return sizes.y / sizes.x; }

/// Chi-square and F take flatter data for normal ones and find as little as in those, or in what
/// they allow for. A value of 1 stands for no second subject or for two values.
double kurtosis_for(const Method& method, double kurtosis, double allowed) {
  return method.is.of_normal_values && kurtosis > 1 ? std::max(3 + allowed, kurtosis)
                                                    : std::max(1.0, kurtosis);
}

stats::LogVariancePlan variance_plan(const Method& method, const stats::ErrorRates& rates,
                                     double allow, const PlannedChannel& channel,
                                     double allocation = 1) {
  const stats::ExcessKurtoses allowed = method.frozen.largest_excess_kurtosis();
  return {.kurtosis_x = kurtosis_for(method, channel.kurtosis, allowed.x),
          .kurtosis_y = kurtosis_for(method, channel.other_kurtosis, allowed.y),
          .allocation = allocation,
          .allow = std::exp(allow),
          .rates = rates};
}

std::optional<std::uint64_t> for_variances(const Method& method, const ErrorShare& share,
                                           const PlannedChannel& channel) {
  const Regions& regions = channel.regions;
  if (regions.relation == Relation::within) {
    return stats::log_variance_sample_size(
        variance_plan(method, planned_rates(share, regions), 0, channel), std::exp(regions.within));
  }
  return stats::log_variance_sample_size(
      variance_plan(method, planned_rates(share, regions), regions.allow, channel),
      std::exp(*regions.detect));
}

/// Numbers without spread, and variances of two observations (kurtosis 1), have no power.
bool has_spread(const PlannedChannel& channel) {
  return channel.kurtosis + channel.other_kurtosis > 2;
}

}  // namespace

void LogTheta::check_margin(const Question& question, const Margin& margin) const {
  Theta::check_margin(question, margin);
  if (margin.relative || !question.of_two()) return;
  throw InputError(
      margin.where,
      fmt::format("a margin on a ratio of {} is relative; give it in per cent", plural_));
}

std::optional<std::uint64_t> LogTheta::secondaries(const Question& question,
                                                   const ErrorShare& share, const Pilots& pilots,
                                                   const Plan& plan) const {
  if (!all_piloted(question, pilots)) return std::nullopt;
  return most_of_channels(question, [&](std::size_t i) -> std::optional<std::uint64_t> {
    const Regions& regions = plan.regions[i];
    const std::optional<PlannedChannel> channel = from_pilots(question, i, pilots, plan);
    if (!channel || (regions.relation != Relation::within && !regions.detect)) return std::nullopt;
    return for_variances(plan.method, share, *channel).value_or(impossible_secondaries);
  });
}

std::optional<double> LogTheta::detectable(const Question& question, const TestSize& size,
                                           const Plan& plan, const PlannedChannel& channel) const {
  if (!has_spread(channel)) return std::nullopt;
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  return std::log(stats::log_variance_detectable(
      variance_plan(plan.method, planned_rates(size.share, channel.regions), channel.regions.allow,
                    channel, allocation(sizes)),
      sizes.x));
}

std::optional<double> LogTheta::power(const Question& question, const TestSize& size,
                                      const Plan& plan, const PlannedChannel& channel,
                                      double effect) const {
  if (!has_spread(channel)) return std::nullopt;
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  const bool within = channel.regions.relation == Relation::within;
  const double one_margin = stats::log_variance_power(
      variance_plan(plan.method, planned_rates(size.share, channel.regions),
                    within ? 0 : channel.regions.allow, channel, allocation(sizes)),
      sizes.x, std::exp(within ? channel.regions.within : effect));
  return within ? std::max(0.0, 2 * one_margin - 1) : one_margin;
}

}  // namespace assay::harness
