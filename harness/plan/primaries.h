#pragma once

// Primaries of a secondary where the suite leaves them open.

#include <map>
#include <string>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/theta/family.h"

namespace assay::harness {

/// Primaries of a secondary for each averaging estimator that says `auto`. Variance claims get
/// near-normal secondaries, mean claims a right tail at their level. The number depends on the
/// whole suite, not on a selection.
using Primaries = std::map<std::string, std::uint64_t>;
Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots);

/// Primaries of one subject: 1 for a sampler's draws, the suite's number, or the chosen one.
std::uint64_t primaries_of(const Subject& subject, const Primaries& chosen);

/// True if an observation of the claim is a single primary. Bets take single values: what a rare
/// one loses, they win back from each.
bool takes_single_primaries(const Question& question, const Pilots& pilots);

}  // namespace assay::harness
