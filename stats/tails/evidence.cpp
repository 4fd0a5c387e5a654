#include "stats/tails/evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assay::stats {

Evidence absolute(const Evidence& of_theta) {
  const auto at = [at = of_theta.at](double theta) {
    const TestResult above = at(theta);
    const TestResult below = at(-theta);
    TestResult result = above;
    result.log_p_upper =
        std::min(0.0, std::numbers::ln2 + std::min(above.log_p_upper, below.log_p_lower));
    result.log_p_lower = std::max(above.log_p_lower, below.log_p_upper);
    return result;
  };
  const auto interval = [interval = of_theta.interval](double confidence) -> Interval {
    const Interval of = interval(confidence);
    return {std::max({0.0, of.low, -of.high}), std::max(std::abs(of.low), std::abs(of.high)),
            confidence};
  };
  return {.estimate = std::abs(of_theta.estimate), .at = at, .interval = interval};
}

}  // namespace assay::stats
