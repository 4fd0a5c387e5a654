#pragma once

// Demands of a suite's claims on the pilots of its estimators.

#include <vector>

#include "harness/pilot/pilot.h"

namespace assay::harness {

/// The samplers of a question whose draws need a pilot.
std::vector<const Subject*> piloted_draws(const Question& question);

/// The pilots of a suite's questions. All questions decide what a pilot keeps, so a selection does
/// not change it. The chosen ones decide whether a sampler's draws are piloted.
PilotRun pilot_run_of(const std::vector<Question>& questions, const std::vector<bool>& chosen,
                      std::uint64_t seed, unsigned threads);
/// The same with all chosen.
PilotRun pilot_run_of(const std::vector<Question>& questions, std::uint64_t seed, unsigned threads);

}  // namespace assay::harness
