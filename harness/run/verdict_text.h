#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "harness/plan/outcome.h"

namespace assay::harness {

/// A tested claim's verdict in one or two sentences. They say what was found, what is excluded, and
/// what could be missed or how many more samples would decide.
std::string narrate(const TestOutcome& outcome);

/// The observations of the look that the p of all looks is from; 0 if that is the last.
std::uint64_t earlier_look(std::span<const reports::Look> looks);

/// The evidence by which Holm alone refutes a claim.
struct HolmFinding {
  const reports::Effect& effect;
  std::string channel = "";  ///< "": the claim has one channel
  double log_p = 0;
  double log_p_adjusted = 0;
  std::uint64_t earlier_look = 0;  ///< the look that gave the p, if not the last
};

/// The verdict of a claim that only Holm's adjustment refutes.
std::string narrate_holm(const HolmFinding& found);

}  // namespace assay::harness
