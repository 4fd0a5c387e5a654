#include "harness/base/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace assay::harness {

using reports::Number;

Number number(double value) { return std::isfinite(value) ? Number(value) : Number(); }

Number probability(double log_p) {
  return std::max(std::exp(log_p), std::numeric_limits<double>::denorm_min());
}

Number log10_of(double log_p) { return log_p / std::log(10.0); }

}  // namespace assay::harness
