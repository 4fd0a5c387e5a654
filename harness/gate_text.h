#pragma once

// Red gates in words.

#include <string>
#include <vector>

#include "harness/outcome.h"

namespace assay::harness {

/// What is wrong with the data, a sentence a red gate; "" where none is.
std::string red_gates(const std::vector<reports::Gate>& gates);

/// What would turn the outcome's red gates green: rows of a file, or primaries and secondaries of
/// an estimator. "" where the gates say it themselves.
std::string what_would_help(const TestOutcome& outcome);

}  // namespace assay::harness
