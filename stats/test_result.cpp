#include "stats/test_result.h"

#include <algorithm>
#include <numbers>

namespace assay::stats {

double log_p_two_sided(const TestResult& result) {
  return std::min(0.0, std::numbers::ln2 + std::min(result.log_p_lower, result.log_p_upper));
}

}  // namespace assay::stats
