#pragma once

// Which method is valid for a claim on variances or costs, and from how many secondaries on: what
// `choose_method` says of them.

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Of variances: F and chi-square where the pilot predicts near-normal secondaries; else the
/// logarithm of the variance with its own kurtosis, from as many secondaries on as that needs; else
/// nothing.
std::uint64_t choose_for_variance(const Question& question, const FamilyPlace& place,
                                  const Pilots& pilots, std::uint64_t most, Plan& plan);

/// Of efficiencies, total variances and slopes of variances, which have one method each: from how
/// many secondaries on the logarithm of every variance, and of every mean cost, that is part of the
/// claim is near normal.
std::uint64_t choose_for_spread(const Question& question, const FamilyPlace& place,
                                const Pilots& pilots, std::uint64_t most, Plan& plan);

/// Of costs: from how many secondaries on the logarithm of every mean cost is near normal.
std::uint64_t choose_for_costs(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, std::uint64_t most, Plan& plan);

}  // namespace assay::harness
