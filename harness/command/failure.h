#pragma once

#include <string>

#include "estimators/core/value.h"

namespace assay::harness {

/// Prints a mistake: place and sentence (in_lines), then the line with a caret. `claim` is the text
/// of the place `claim` (a claim from the command line).
std::string failure_text(const InputError& error, const std::string& claim);

/// A sentence after `assay: `, in lines of 80 columns. What stands in backticks, or has no blank,
/// is in one piece, to be pasted.
std::string in_lines(const std::string& sentence);

}  // namespace assay::harness
