#pragma once

// Shapes that a method has to bear, from the pilot or the rows of a file.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/plan/sizes.h"

namespace assay::harness {

/// Prior knowledge of one channel of one subject.
struct Known {
  std::size_t subject;
  std::size_t channel;
  PilotChannel pilot;
  double averaged;  ///< The pilot's values in a secondary.
  bool rows;        ///< The test's own data, not a pilot's.
  std::string label;
};

/// The pilot's values of one channel as secondaries of so many primaries. They stay as they are if
/// the subject does not average, or has rows of a file.
std::vector<double> as_secondaries(const Subject& side, std::span<const double> values,
                                   std::uint64_t primaries);

/// The channels that pilots or rows show, without those that never vary.
std::vector<Known> known_channels(const TestOutcome& test, const Pilots& pilots);

/// Notes a gate of the pilot, but none of rows: they are judged with the test's own data.
void note(Plan& plan, const Known& known, const stats::Gate& gate);

/// True if the values beyond half the way from their mean to an end are few: there may be more.
bool hides(std::span<const double> values, double mean, double end);

/// True if a claim on means rests on the range that its channels declare: bets are its method.
/// Every end that a decision needs is finite, and a pilot saw few values in the outer half before
/// one, or none that vary. Two means are bet on only if both are constant.
bool bets_on_range(const Question& question, const Pilots& pilots);

}  // namespace assay::harness
