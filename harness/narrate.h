#pragma once

#include <string>

#include "harness/outcome.h"

namespace assay::harness {

/// What a tested claim's verdict means in one or two sentences: what was found, what was excluded,
/// what could have been missed, or how many more samples would decide.
std::string narrate(const TestOutcome& outcome);

/// A value of theta as a reader sees it: per cent, a factor, or a number.
std::string show_theta(double theta, const Evidence& evidence);

}  // namespace assay::harness
