#pragma once

// How many secondaries each subject has in a look.

#include "harness/plan/outcome.h"
#include "harness/plan/planned_channel.h"
#include "stats/planning/power.h"

namespace assay::harness {

/// The largest look that a test may come to: what it asks for, or `most`.
std::uint64_t largest_look(const Question& question, std::uint64_t most);

/// In a look of this size those of the subject that has fewest, and how many times as many another
/// has.
std::uint64_t fewest_secondaries(const Question& question, std::uint64_t look);
double times_the_fewest(const Question& question, std::size_t subject, std::uint64_t look);

/// The sizes of the first and of the second subject; where there is one, it is both.
stats::SampleSizes sizes_of(const Question& question, std::uint64_t look);

/// A computed count as a number of secondaries, rounded up; `impossible_secondaries` where it is
/// larger than any or no number.
std::uint64_t whole_secondaries(double count);

/// The reason why a test is invalid, among its gates.
void note_too_few(Plan& plan, std::uint64_t size, std::uint64_t needed);

}  // namespace assay::harness
