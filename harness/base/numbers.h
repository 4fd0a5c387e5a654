#pragma once

// Numbers as a record has them.

#include "reports/record/record.h"

namespace assay::harness {

/// The value, or nothing if it is not finite.
reports::Number number(double value);

/// The probability of a natural logarithm; the least double stands for what underflows.
reports::Number probability(double log_p);

/// The decimal logarithm of a natural one.
reports::Number log10_of(double log_p);

}  // namespace assay::harness
