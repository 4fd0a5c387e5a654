#include "stats/gates/normal_test.h"

#include <cmath>

#include "stats/tails/tails.h"

namespace assay::stats {

TestResult normal_test(NormalEstimate estimate) {
  const double z = estimate.value / estimate.standard_error;
  const LogTails tails = normal_tails(z);
  return {z, {"normal", {}}, tails.lower, tails.upper, Exactness::asymptotic};
}

Interval normal_interval(NormalEstimate estimate, double confidence) {
  const double half =
      normal_quantile({Tail::upper, std::log((1 - confidence) / 2)}) * estimate.standard_error;
  return {estimate.value - half, estimate.value + half, confidence};
}

}  // namespace assay::stats
