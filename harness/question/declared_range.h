#pragma once

#include <string>

#include "harness/question/question.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

/// Names a value outside the range that its channel declares (`low`, `high`), beyond a sum's
/// rounding; "" if there is none. The range decides on methods, above all `bounded`. Mutants (which
/// have their original's declaration), images and ready-made data are not checked.
std::string outside_of_range(const Subject& subject, const Summary& drawn);

}  // namespace assay::harness
