#pragma once

// Sizes of tests, and the effects that they find. Each family has its own formulas (Theta).

#include <cstdint>
#include <functional>
#include <optional>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/theta/theta.h"

namespace assay::harness {

/// True if every subject has a pilot.
bool all_piloted(const Question& question, const Pilots& pilots);

/// The distance to find from the claimed region's edge; 0 if there is none.
double distance_of(const Regions& regions);

using SizeOfChannel = std::function<std::optional<std::uint64_t>(std::size_t channel)>;

/// The most secondaries that a channel needs; nullopt if none says.
std::optional<std::uint64_t> most_over_channels(const Question& question,
                                                const SizeOfChannel& of_channel);
/// The same, `least_secondaries` at least and `impossible_secondaries` at most.
std::optional<std::uint64_t> most_of_channels(const Question& question,
                                              const SizeOfChannel& of_channel);

/// The least theta that a test of that size finds with probability 1 - beta. Nullopt if no formula
/// tells, and `within`.
std::optional<double> detectable_effect(const Question& question, const TestSize& size,
                                        const Plan& plan, const PlannedChannel& channel);

/// Theta::power, or nullopt if the method has no formula.
std::optional<double> power_at(const Question& question, const TestSize& size, const Plan& plan,
                               const PlannedChannel& channel, double effect);

}  // namespace assay::harness
