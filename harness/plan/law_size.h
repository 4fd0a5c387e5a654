#pragma once

// How many secondaries claims about laws take, and what they find: a helper of sample_size.

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/plan/planned_channel.h"

namespace assay::harness {

/// For `detect`: counts in cells by the noncentral chi-square, distances by Hoeffding's bound, a
/// sampler's bookkeeping by the normal law. Where two parts share the level (two-part-ks), each at
/// half of it, and as many more as the atom takes from the rest.
std::optional<std::uint64_t> laws_secondaries(const Question& question, const ErrorShare& share,
                                              const Plan& plan);

/// The least theta found with probability 1 - beta, infinite where there is none.
double detectable_between_laws(const Question& question, const TestSize& size, const Plan& plan);

/// The probability, or a lower bound of it, of failing the claim when theta is `effect`.
double power_between_laws(const Question& question, const TestSize& size, const Plan& plan,
                          double effect);

}  // namespace assay::harness
