#pragma once

// Red gates in words.

#include <exception>
#include <string>
#include <vector>

#include "harness/plan/outcome.h"

namespace assay::harness {

/// What is wrong with the data, a sentence a red gate; "" where none is.
std::string red_gates(const std::vector<reports::Gate>& gates);

/// What stats refuses to compute, as a sentence: "function: " before it is no news to a reader.
std::string in_words(const std::exception& error);

/// So many times the look's secondaries of each subject that is compared: "1200", or "1200 and 750"
/// where they have not as many.
std::string sizes_text(const TestOutcome& outcome, double factor);

/// What would turn the outcome's red gates green: rows of a file, or primaries and secondaries of
/// an estimator; of heavy tails a claim that does not rest on their moments, or tails that end. ""
/// where the gates say it themselves.
std::string what_would_help(const TestOutcome& outcome);

}  // namespace assay::harness
