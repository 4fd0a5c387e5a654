#include "stats/tails/test_result.h"

#include "stats/tails/tails.h"

namespace assay::stats {

double log_p_two_sided(const TestResult& result) {
  return log_p_two_sided(LogTails{result.log_p_lower, result.log_p_upper});
}

}  // namespace assay::stats
