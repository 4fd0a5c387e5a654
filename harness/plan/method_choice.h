#pragma once

// Choice of a method that is valid for the pilot's data, and from how many secondaries on.

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Chooses the plan's method once primaries and regions are known, and notes the gates. Sets
/// `invalid` if no method is valid; keeps a forced method. Returns the fewest secondaries for a
/// meaningful test. `most` is how many there can be.
std::uint64_t choose_method(const Question& question, const FamilyPlace& place,
                            const Pilots& pilots, std::uint64_t most, Plan& plan);

}  // namespace assay::harness
