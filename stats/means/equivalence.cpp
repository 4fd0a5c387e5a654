#include "stats/means/equivalence.h"

#include <algorithm>

namespace assay::stats {

Equivalence equivalence(const TestResult& at_low, const TestResult& at_high) {
  return {at_low, at_high, std::max(at_low.log_p_upper, at_high.log_p_lower)};
}

}  // namespace assay::stats
