#pragma once

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/plan/planned_channel.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Secondaries of each subject that find `detect`, or prove `within`, with this share of errors in
/// every channel. Returns nullopt without a margin or a pilot. Returns `impossible_secondaries` if
/// no number does, the reference's own error being too large.
std::optional<std::uint64_t> planned_secondaries(const Question& question, const ErrorShare& share,
                                                 const Pilots& pilots, const Plan& plan);

/// Secondaries that the test asks for or is worth; all rows of a file. `most` is how many there can
/// be.
std::uint64_t intended_secondaries(const Question& question, const FamilyPlace& place,
                                   const Pilots& pilots, std::uint64_t most, const Plan& plan);

/// The worst channel of a claim on costs, efficiencies or total variances, by the pilots. In it 1 +
/// the spread of each side's logarithm stands for a kurtosis. Returns nullopt for other claims,
/// without a pilot, or without spread.
std::optional<PlannedChannel> planned_log_channel(const Question& question, const Regions& regions,
                                                  const Pilots& pilots, const Plan& plan);

/// The least theta that a test of that size finds with probability 1 - beta.
std::optional<double> detectable_effect(const Question& question, const TestSize& size,
                                        const Plan& plan, const PlannedChannel& channel);

/// True if no theta in the declared range is found with probability 1 - beta.
bool finds_nothing(const Question& question, const TestSize& size, const Plan& plan,
                   const PlannedChannel& channel);

/// Probability of failing the claim if theta is `effect`. For `<` and `>` it is that of passing
/// with this advantage, for `within` that of passing at theta = 0.
std::optional<double> power_at(const Question& question, const TestSize& size, const Plan& plan,
                               const PlannedChannel& channel, double effect);

/// A channel from the test's own data, to report on its size.
PlannedChannel observed_channel(const Question& question, const Regions& regions,
                                std::size_t channel, std::span<const ChannelData> data);

}  // namespace assay::harness
