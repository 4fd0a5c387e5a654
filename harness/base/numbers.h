#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "reports/record/record.h"

namespace assay::harness {

/// The value, or nothing if it is not finite.
inline reports::Number number(double value) {
  return std::isfinite(value) ? reports::Number(value) : reports::Number();
}

/// exp(log_p), or the least double if that underflows.
inline reports::Number probability(double log_p) {
  return std::max(std::exp(log_p), std::numeric_limits<double>::denorm_min());
}

/// log10 of a probability whose natural logarithm is `log_p`.
inline reports::Number log10_of(double log_p) { return log_p / std::log(10.0); }

}  // namespace assay::harness
