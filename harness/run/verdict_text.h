#pragma once

#include <string>

#include "harness/plan/outcome.h"

namespace assay::harness {

/// A tested claim's verdict in one or two sentences. They say what was found, what is excluded, and
/// what could be missed or how many more samples would decide.
Reason narrate(const TestOutcome& outcome);

/// Says that these observations exclude no `what` ("exponent"), and what to do.
Reason excludes_no(const std::string& what, const TestOutcome& outcome);

}  // namespace assay::harness
