#pragma once

// How many secondaries a test is to have before any look at the shape of its data, and what is said
// where its shape asks for more.

#include "harness/outcome.h"
#include "harness/pilot.h"
#include "stats/power.h"

namespace assay::harness {

/// The largest look that a test may come to: what it asks for, or `most`.
std::uint64_t largest_look(const Question& question, std::uint64_t most);

/// In a look of this size those of the subject that has fewest, and how many times as many another
/// has.
std::uint64_t fewest_secondaries(const Question& question, std::uint64_t look);
double times_the_fewest(const Question& question, std::size_t subject, std::uint64_t look);

/// The sizes of the first and of the second subject; where there is one, it is both.
stats::SampleSizes sizes_of(const Question& question, std::uint64_t look);

/// How many secondaries the test asks for, or is worth; all rows where there are rows. `most` is
/// how many there can be.
std::uint64_t intended_secondaries(const Question& question, const FamilyPlace& place,
                                   const Pilots& pilots, std::uint64_t most, const Plan& plan);

/// A computed count as a number of secondaries, rounded up; `impossible_secondaries` where it is
/// larger than any or no number.
std::uint64_t whole_secondaries(double count);

/// The reason why a test is invalid, among its gates.
void note_too_few(Plan& plan, std::uint64_t size, std::uint64_t needed);

}  // namespace assay::harness
