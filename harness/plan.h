#pragma once

// From the pilot to frozen plans: how many primaries make a secondary, which method is valid, how
// many secondaries find `detect` with the suite's error rates.

#include <map>
#include <vector>

#include "harness/outcome.h"
#include "harness/pilot.h"

namespace assay::harness {

/// Primaries a secondary of each estimator that averages and says `auto`: enough for every variance
/// claim of the suite that names it to have near-normal secondaries, and for every mean claim's
/// tail to be right at the level it is tested at. A function of the whole suite, not of a
/// selection.
using Primaries = std::map<std::string, std::uint64_t>;
Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots);

/// The plan of one test.
Plan plan_test(const Question& question, const FamilyPlace& place, const Pilots& pilots,
               const Primaries& primaries);

/// The normal quantile beyond which a test of this share rejects.
double critical_value(double alpha, bool two_sided);

}  // namespace assay::harness
