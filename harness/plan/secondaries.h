#pragma once

// Secondaries of each subject in a look.

#include "harness/plan/outcome.h"
#include "harness/theta/planned_channel.h"
#include "stats/planning/power.h"

namespace assay::harness {

/// The largest look of a test: the size that it asks for, or `most`.
std::uint64_t largest_look(const Question& question, std::uint64_t most);

/// Secondaries of the subject with fewest in a look of this size, and how many times as many
/// another has.
std::uint64_t fewest_secondaries(const Question& question, std::uint64_t look);
double times_the_fewest(const Question& question, std::size_t subject, std::uint64_t look);

/// Sizes of the two subjects; a single one is both.
stats::SampleSizes sizes_of(const Question& question, std::uint64_t look);

/// Secondaries that the floor of evidence asks for (critical.h), at least `least_secondaries`. Rows
/// of a file, pictures and files that a program writes are as many as somebody paid for: they have
/// no floor.
std::uint64_t secondaries_of_floor(const Question& question, const Plan& plan);

/// A computed count, rounded up; `impossible_secondaries` if it is too large or NaN.
std::uint64_t whole_secondaries(double count);

}  // namespace assay::harness
