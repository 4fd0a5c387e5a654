#include "harness/plan/sample_size.h"

#include <algorithm>
#include <cmath>

#include "harness/plan/critical.h"
#include "harness/plan/rows.h"

namespace assay::harness {

bool all_piloted(const Question& question, const Pilots& pilots) {
  return std::ranges::all_of(question.subjects,
                             [&](const Subject& s) { return pilot_of(s, pilots) != nullptr; });
}

double distance_of(const Regions& regions) {
  if (regions.relation == Relation::within) return regions.within;
  return regions.detect ? *regions.detect - regions.allow : 0;
}

std::optional<std::uint64_t> most_over_channels(const Question& question,
                                                const SizeOfChannel& of_channel) {
  std::optional<std::uint64_t> most;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const std::optional<std::uint64_t> count = of_channel(channel);
    if (count) most = std::max(most.value_or(0), *count);
  }
  return most;
}

std::optional<std::uint64_t> most_of_channels(const Question& question,
                                              const SizeOfChannel& of_channel) {
  const auto most = most_over_channels(question, of_channel);
  if (!most) return most;
  return std::clamp(*most, least_secondaries, impossible_secondaries);
}

std::optional<double> detectable_effect(const Question& question, const TestSize& size,
                                        const Plan& plan, const PlannedChannel& channel) {
  if (channel.regions.relation == Relation::within) return std::nullopt;  // it finds nothing
  const std::optional<double> found = question.theta->detectable(question, size, plan, channel);
  return found && std::isfinite(*found) ? found : std::nullopt;
}

std::optional<double> power_at(const Question& question, const TestSize& size, const Plan& plan,
                               const PlannedChannel& channel, double effect) {
  return question.theta->power(question, size, plan, channel, effect);
}

}  // namespace assay::harness
