#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "harness/plan/outcome.h"

namespace assay::harness {

/// What a tested claim's verdict means in one or two sentences: what was found, what was excluded,
/// what could have been missed, or how many more samples would decide.
std::string narrate(const TestOutcome& outcome);

/// The observations of the look that the p of all looks is from; 0 where that is the last.
std::uint64_t earlier_look(std::span<const reports::Look> looks);

/// What Holm's adjustment over the suite alone refutes a claim by.
struct HolmFinding {
  const reports::Effect& effect;
  std::string channel = "";  ///< "": the claim has no other
  double log_p = 0;
  double log_p_adjusted = 0;
  std::uint64_t earlier_look = 0;  ///< whose p that is, if not the last look's
};

/// The same of a claim that only Holm's adjustment over the suite refutes.
std::string narrate_holm(const HolmFinding& found);

}  // namespace assay::harness
