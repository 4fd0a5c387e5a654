#pragma once

// Sizes for the exact tests of a mean in a declared range (`binomial`, `bounded`), for sample_size.

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/plan/planned_channel.h"
#include "stats/planning/power.h"

namespace assay::harness {

/// Secondaries at which every outcome fails the claim or excludes `detect`; nullopt if no number
/// does. Two samples take 1.4 times Welch's (stats/means/two_valued.h).
std::optional<std::uint64_t> exact_secondaries(const Question& question, const Plan& plan,
                                               const PlannedChannel& channel,
                                               const stats::ErrorRates& rates);

/// Secondaries at which both one-sided tests at share.beta prove the margin with probability 1 -
/// share.beta if theta is 0. Returns nullopt if no number does.
std::optional<std::uint64_t> exact_equivalence_secondaries(const Question& question,
                                                           const Plan& plan,
                                                           const PlannedChannel& channel,
                                                           const ErrorShare& share);

/// The least theta found with probability 1 - beta, the larger of both sides. Returns nullopt if
/// none is quoted: within a margin, of two samples, or without a range.
std::optional<double> exact_detectable_effect(const Question& question, const TestSize& size,
                                              const Plan& plan, const PlannedChannel& channel,
                                              const stats::ErrorRates& rates);

/// True if neither side has a mean in the range that is found with probability 1 - beta.
bool exact_finds_nothing(const Question& question, const TestSize& size, const Plan& plan,
                         const PlannedChannel& channel, const stats::ErrorRates& rates);

/// The probability of finding `effect`, the smaller of both sides; nullopt as above.
std::optional<double> exact_power_at(const Question& question, const TestSize& size,
                                     const Plan& plan, const PlannedChannel& channel,
                                     const stats::ErrorRates& rates, double effect);

}  // namespace assay::harness
