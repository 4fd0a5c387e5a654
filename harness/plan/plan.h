#pragma once

// From the pilot to frozen plans: how many primaries make a secondary, which method is valid, how
// many secondaries find `detect` with the suite's error rates.

#include "harness/draws/sampler_setup.h"
#include "harness/plan/outcome.h"
#include "harness/plan/primaries.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// The plan of one test. InputError at the test's place where its margin is beyond reach.
Plan plan_test(const Question& question, const FamilyPlace& place, const Pilots& pilots,
               const Primaries& primaries);

/// What a test says whose claim needs a density that cannot be had.
std::string lack_of_density(const Question& question, const NoDensity& why);

/// Primaries that a secondary of each subject costs together; of an image in all its elements.
std::uint64_t primaries_of_each(const Question& question, const Plan& plan);

/// Primaries that a look of this size takes, all subjects together.
std::uint64_t primaries_of_look(const Question& question, const Plan& plan, std::uint64_t look);

}  // namespace assay::harness
