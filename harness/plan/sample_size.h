#pragma once

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/plan/planned_channel.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Secondaries of each subject that find `detect` (or prove `within`) with this share of alpha and
/// beta in every channel; nullopt where nothing asks for a number: no `detect`, or no pilot.
/// `impossible_secondaries` where no number would do, the reference's own error being too large.
std::optional<std::uint64_t> planned_secondaries(const Question& question, const ErrorShare& share,
                                                 const Pilots& pilots, const Plan& plan);

/// How many secondaries the test asks for, or is worth; all rows where there are rows. `most` is
/// how many there can be.
std::uint64_t intended_secondaries(const Question& question, const FamilyPlace& place,
                                   const Pilots& pilots, std::uint64_t most, const Plan& plan);

/// What the pilots say of a claim on costs, efficiencies or total variances, the worst over its
/// channels: 1 + the spread of each side's logarithm stands for a kurtosis. nullopt for other
/// claims, where an estimator has no pilot, and where nothing spreads: exact costs.
std::optional<PlannedChannel> planned_log_channel(const Question& question, const Regions& regions,
                                                  const Pilots& pilots, const Plan& plan);

/// The least theta that a test of that size finds with probability 1 - beta.
std::optional<double> detectable_effect(const Question& question, const TestSize& size,
                                        const Plan& plan, const PlannedChannel& channel);

/// Whether no theta that a declared range allows is found with probability 1 - beta.
bool finds_nothing(const Question& question, const TestSize& size, const Plan& plan,
                   const PlannedChannel& channel);

/// The probability of failing the claim when theta is `effect`; of `<` and `>` the probability of
/// passing it with that advantage, of `within` that of passing it when theta is 0.
std::optional<double> power_at(const Question& question, const TestSize& size, const Plan& plan,
                               const PlannedChannel& channel, double effect);

/// A channel from the test's own data, for what is reported about its n.
PlannedChannel observed_channel(const Question& question, const Regions& regions,
                                std::size_t channel, std::span<const ChannelData> data);

}  // namespace assay::harness
