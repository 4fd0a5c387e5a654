#pragma once

// Sizes of claims about laws, and the effects that they find, for sample_size.

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/plan/planned_channel.h"

namespace assay::harness {

/// Size for `detect`: counts in cells by the noncentral chi-square, distances by Hoeffding's bound,
/// a sampler's bookkeeping by the normal law. The parts of two-part-ks have half the level each,
/// and as many more observations as the atom takes from the rest.
std::optional<std::uint64_t> laws_secondaries(const Question& question, const ErrorShare& share,
                                              const Plan& plan);

/// The least theta found with probability 1 - beta; infinite if there is none.
double detectable_between_laws(const Question& question, const TestSize& size, const Plan& plan);

/// The probability, or a lower bound of it, of failing the claim when theta is `effect`.
double power_between_laws(const Question& question, const TestSize& size, const Plan& plan,
                          double effect);

}  // namespace assay::harness
