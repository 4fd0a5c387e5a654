#pragma once

// What the pilot, or the rows of a file, tell of the shapes that a method has to bear.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"
#include "stats/gates/assumption_gates.h"
#include "stats/gates/pareto_tail.h"

namespace assay::harness {

/// What is known beforehand of one channel of one subject.
struct Known {
  std::size_t subject;
  std::size_t channel;
  PilotChannel pilot;
  double averaged;  ///< how many of the pilot's values make a secondary
  double times;     ///< as many secondaries as the subject with fewest has
  bool rows;        ///< the test's own data, not a pilot's
  std::string label;
};

/// The pilot's values of one channel as secondaries of so many primaries; as they are where the
/// subject does not average, or has rows of a file.
std::vector<double> as_secondaries(const Subject& side, std::span<const double> values,
                                   std::uint64_t primaries);

/// Why nothing can be chosen by the pilot: values whose powers are no numbers. "" where all is
/// well.
std::string unusable_pilot(const Question& question, const Pilots& pilots);

/// `look` is the largest there may be.
std::vector<Known> known_channels(const Question& question, const Pilots& pilots,
                                  std::uint64_t look, const Plan& plan);

/// The method chosen asks nothing of the shape that the pilot's gates complain of.
void answer_red_gates(Plan& plan);

/// Notes a gate of the pilot; rows of a file are judged with the test's own data.
void note(Plan& plan, const Known& known, const stats::Gate& gate);

/// Notes the tails' gates; says why the claim cannot be tested where one is too heavy.
std::string too_heavy(const Question& question, const std::vector<Known>& channels,
                      stats::TailClaim claim, Plan& plan);

}  // namespace assay::harness
