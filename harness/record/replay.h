#pragma once

// `assay replay`: draws a recorded test, or one of its observations, again.

#include "harness/record/recorded_test.h"

namespace assay::harness {

/// Prints what was drawn. Returns 1 if something could not be.
int replay(const ReplayArguments&);

}  // namespace assay::harness
