#pragma once

// `assay replay`: a recorded test, or one of its observations, drawn again.

#include "harness/record/recorded_test.h"

namespace assay::harness {

/// Prints what was drawn. 1 where something could not be.
int replay(const ReplayArguments&);

}  // namespace assay::harness
