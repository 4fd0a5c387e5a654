#pragma once

// How many secondaries the exact tests of a mean in a declared range take (`binomial`, `bounded`):
// a helper of sample_size.

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/plan/planned_channel.h"
#include "stats/planning/power.h"

namespace assay::harness {

/// Secondaries at which every outcome fails the claim or excludes `detect`; nullopt where no number
/// would do. Of two samples 1.4 times Welch's (stats/two_valued.h).
std::optional<std::uint64_t> exact_secondaries(const Question& question, const Plan& plan,
                                               const PlannedChannel& channel,
                                               const stats::ErrorRates& rates);

/// Secondaries at which both one-sided tests at share.beta show that theta lies within the margin,
/// with probability 1 - share.beta together, where it is 0; nullopt where no number would do.
std::optional<std::uint64_t> exact_equivalence_secondaries(const Question& question,
                                                           const Plan& plan,
                                                           const PlannedChannel& channel,
                                                           const ErrorShare& share);

/// The least theta found with probability 1 - beta, the larger of both sides; nullopt where there
/// is none to quote: within a margin, of two samples, without a range.
std::optional<double> exact_detectable_effect(const Question& question, const TestSize& size,
                                              const Plan& plan, const PlannedChannel& channel,
                                              const stats::ErrorRates& rates);

/// Whether no mean that the range allows is found with probability 1 - beta, on either side.
bool exact_finds_nothing(const Question& question, const TestSize& size, const Plan& plan,
                         const PlannedChannel& channel, const stats::ErrorRates& rates);

/// The probability of finding `effect`, the smaller of both sides; nullopt likewise.
std::optional<double> exact_power_at(const Question& question, const TestSize& size,
                                     const Plan& plan, const PlannedChannel& channel,
                                     const stats::ErrorRates& rates, double effect);

}  // namespace assay::harness
