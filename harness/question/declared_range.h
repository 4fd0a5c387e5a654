#pragma once

#include <string>

#include "harness/question/question.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

/// Which value of the subject's channels lies outside of what the channel declares (`low`, `high`),
/// but for what a sum may be rounded; empty where none does. A declared range chooses methods, and
/// `bounded` rests on it. Of a mutant, which declares what its original does, of images and of
/// ready-made data nothing is said.
std::string outside_of_range(const Subject& subject, const Summary& drawn);

}  // namespace assay::harness
