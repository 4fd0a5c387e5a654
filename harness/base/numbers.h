#pragma once

#include "reports/record/record.h"

namespace assay::harness {

/// The value, or nothing if it is not finite.
reports::Number number(double value);

/// exp(log_p), or the least double if that underflows.
reports::Number probability(double log_p);

/// log10 of a probability whose natural logarithm is `log_p`.
reports::Number log10_of(double log_p);

}  // namespace assay::harness
