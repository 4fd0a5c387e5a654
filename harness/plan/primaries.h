#pragma once

// How many primaries make a secondary, where the suite leaves it open.

#include <map>
#include <string>
#include <vector>

#include "harness/question/pilot.h"
#include "harness/theta/family.h"

namespace assay::harness {

/// Primaries a secondary of each estimator that averages and says `auto`: enough for every variance
/// claim of the suite that names it to have near-normal secondaries, and for every mean claim's
/// tail to be right at the level it is tested at. A function of the whole suite, not of a
/// selection.
using Primaries = std::map<std::string, std::uint64_t>;
Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots);

/// Of one subject: 1 for a sampler's draws, the suite's number, or the chosen one.
std::uint64_t primaries_of(const Subject& subject, const Primaries& chosen);

}  // namespace assay::harness
