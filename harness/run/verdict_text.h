#pragma once

#include "harness/plan/outcome.h"

namespace assay::harness {

/// A tested claim's verdict in one or two sentences. They say what was found, what is excluded, and
/// what could be missed or how many more samples would decide.
Reason narrate(const TestOutcome& outcome);

}  // namespace assay::harness
