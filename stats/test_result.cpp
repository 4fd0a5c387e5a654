#include "stats/test_result.h"

#include <algorithm>
#include <numbers>

#include "stats/tails.h"

namespace assay::stats {

double log_p_two_sided(LogTails tails) {
  return std::min(0.0, std::numbers::ln2 + std::min(tails.lower, tails.upper));
}

double log_p_two_sided(const TestResult& result) {
  return log_p_two_sided(LogTails{result.log_p_lower, result.log_p_upper});
}

}  // namespace assay::stats
