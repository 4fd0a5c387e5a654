#pragma once

#include <string>

#include "estimators/value.h"

namespace assay::harness {

/// What is printed under `assay: ` for a mistake: the place and the sentence, then the line with a
/// caret. `claim` is the text of the place `claim` (a claim from the command line).
std::string failure_text(const InputError& error, const std::string& claim);

}  // namespace assay::harness
