#pragma once

// The choice of a method for claims on variances or costs.

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// For variances: F and chi-square if the pilot predicts near-normal secondaries, else log-variance
/// with as many secondaries as it needs, else none.
std::uint64_t choose_for_variance(const Question& question, const FamilyPlace& place,
                                  const Pilots& pilots, std::uint64_t most, Plan& plan);

/// For efficiencies, total variances and slopes of variances, which have one method each. Returns
/// from how many secondaries the logarithm of every variance and mean cost in the claim is near
/// normal.
std::uint64_t choose_for_spread(const Question& question, const FamilyPlace& place,
                                const Pilots& pilots, std::uint64_t most, Plan& plan);

/// For costs: returns from how many secondaries the logarithm of every mean cost is near normal.
std::uint64_t choose_for_costs(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, std::uint64_t most, Plan& plan);

}  // namespace assay::harness
