#pragma once

#include <string>

#include "harness/plan/outcome.h"

namespace assay::harness {

/// A tested claim's verdict in one or two sentences. They say what was found, what is excluded, and
/// what could be missed or how many more samples would decide.
Reason narrate(const TestOutcome& outcome);

/// Says that no observations of this number could fail the claim, and what to do. They exclude no
/// `what`: "exponent".
Reason excludes_no(const std::string& what);

}  // namespace assay::harness
