#pragma once

// The looks of a test: its interim analyses. Each has a size and levels.

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// Throws InputError if somebody chose the size of a claim in seconds.
void require_free_size(const TestOutcome& test);

/// Looks that grow from the fewest meaningful up to what `detect` needs at the last look's levels.
/// One look if nothing asks for a number or it is given: rows of a file, `secondaries`, the
/// classical 1000. `range` has the fewest meaningful and the most available.
stats::LookSchedule plan_looks(const TestOutcome& test, const Pilots& pilots,
                               const stats::LookRange& range);

stats::LookSchedule one_look(std::uint64_t secondaries, const ErrorShare& share);

/// The only look of a plan may be put off to these sizes. Each is twice the one before, the last at
/// most 64 times the look, and `most`. Empty with several looks, or if somebody chose the size.
std::vector<std::uint64_t> postponed_looks(const TestOutcome& test, std::uint64_t most);

/// The look of a test that is invalid beforehand. It decides nothing; it shows the estimators'
/// data.
stats::LookSchedule look_for_its_picture(const TestOutcome& test);

/// The largest look. It has the rows of the longest file, also for a side drawn beside it. A budget
/// in primaries pays for it after the pilots.
std::uint64_t most_available(const TestOutcome& test, const Pilots& pilots);

/// Primaries of a look of this size, all subjects together; of an image, in all its elements.
std::uint64_t primaries_of_look(const TestOutcome& test, std::uint64_t look);

}  // namespace assay::harness
