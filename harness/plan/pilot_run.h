#pragma once

// What a suite's claims want of the pilots of its estimators.

#include <vector>

#include "harness/question/pilot.h"

namespace assay::harness {

/// The pilots of a suite's questions. What they keep and how large they may be is wished by all
/// questions, so that an estimator's pilot is the same whichever tests are chosen; whether it is
/// drawn at all, by those that are.
PilotRun pilot_run_of(const std::vector<Question>& questions, const std::vector<bool>& chosen,
                      std::uint64_t seed, unsigned threads);
/// The same where all are chosen.
PilotRun pilot_run_of(const std::vector<Question>& questions, std::uint64_t seed, unsigned threads);

}  // namespace assay::harness
