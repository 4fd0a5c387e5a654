#pragma once

// From the pilot to frozen plans: primaries of a secondary, method, and secondaries that find
// `detect` with the suite's error rates.

#include "harness/draws/sampler_setup.h"
#include "harness/plan/outcome.h"
#include "harness/plan/primaries.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// The plan of one test. Throws InputError at the test's place if its margin is beyond reach.
Plan plan_test(const Question& question, const FamilyPlace& place, const Pilots& pilots,
               const Primaries& primaries);

/// The message of a test whose claim needs a density that cannot be had.
std::string lack_of_density(const Question& question, const NoDensity& why);

/// Primaries of one secondary of each subject together; for an image, in all its elements.
std::uint64_t primaries_of_each(const Question& question, const Plan& plan);

/// Primaries of a look of this size, all subjects together.
std::uint64_t primaries_of_look(const Question& question, const Plan& plan, std::uint64_t look);

}  // namespace assay::harness
