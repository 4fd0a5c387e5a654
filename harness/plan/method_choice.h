#pragma once

// Which method is valid for the data that the pilot promises, and from how many secondaries on.

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Chooses the plan's method, primaries and regions being known, and notes the gates it was chosen
/// by; `invalid` is set where no method is valid. A method forced by the test is kept. Returns the
/// fewest secondaries of which a test by it means anything. `most` is how many there can be.
std::uint64_t choose_method(const Question& question, const FamilyPlace& place,
                            const Pilots& pilots, std::uint64_t most, Plan& plan);

}  // namespace assay::harness
