#pragma once

#include <string>

#include "estimators/core/value.h"

namespace assay::harness {

/// The message for a mistake: place and sentence (in_lines), then the line with a caret. The text
/// `claim` is that of a claim from the command line.
std::string failure_text(const InputError& error, const std::string& claim);

/// A sentence after `assay: `, in lines of 80 columns. Text in backticks stays unbroken, to be
/// pasted.
std::string in_lines(const std::string& sentence);

}  // namespace assay::harness
