#include "stats/gates/normal_test.h"

#include <cmath>

#include "stats/tails/tails.h"

namespace assay::stats {

TestResult normal_test(NormalEstimate estimate) {
  const double z = estimate.value / estimate.standard_error;
  const LogTails tails = normal_tails(z);
  return {z, {"normal", {}}, tails.lower, tails.upper, Exactness::asymptotic};
}

}  // namespace assay::stats
