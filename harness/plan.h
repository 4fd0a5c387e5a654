#pragma once

// From the pilot to frozen plans: how many primaries make a secondary, which method is valid, how
// many secondaries find `detect` with the suite's error rates.

#include "harness/outcome.h"
#include "harness/pilot.h"
#include "harness/primaries.h"

namespace assay::harness {

/// The plan of one test. InputError at the test's place where its margin is beyond reach.
Plan plan_test(const Question& question, const FamilyPlace& place, const Pilots& pilots,
               const Primaries& primaries);

}  // namespace assay::harness
