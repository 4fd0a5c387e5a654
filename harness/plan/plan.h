#pragma once

// From the pilot to frozen plans: primaries of a secondary, method, and secondaries that find
// `detect` with the suite's error rates.

#include <map>
#include <string>
#include <vector>

#include "harness/draws/sampler_setup.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/theta/decision.h"

namespace assay::harness {

/// Places of a suite's questions, in order. Inside the family alpha is split by weight, then evenly
/// over a claim's channels. A test outside has the smallest share in the suite, and beta over the
/// number of tests outside. A suite of mutants only shares out alpha among them. A test without a
/// question keeps its part.
std::vector<FamilyPlace> places(const Suite& suite, const std::vector<Question>& questions);

/// Primaries of a secondary for each averaging estimator that says `auto`. Variance claims get
/// near-normal secondaries, mean claims a right tail at their level. The number depends on the
/// whole suite, not on a selection.
using Primaries = std::map<std::string, std::uint64_t>;
Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots);

/// One test with its plan. Where the pilots show a mistake, as a margin beyond reach, it is an
/// error.
TestOutcome plan_test(Question asked, const FamilyPlace& place, const Pilots& pilots,
                      const Primaries& primaries);
/// The same as a suite of its own, drawn by itself.
TestOutcome plan_alone(const Suite& suite, const Question& question, const Pilots& pilots);

/// A sentence on a `detect` without per cent that is nearly all of what is claimed, or next to
/// nothing of it; "" for another.
std::string doubtful_margin(const Question& question, const Pilots& pilots);

/// The message of a test whose claim needs a density that cannot be had.
std::string lack_of_density(const Question& question, const NoDensity& why);

}  // namespace assay::harness
