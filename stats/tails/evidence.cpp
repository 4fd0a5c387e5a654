#include "stats/tails/evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/basics/search.h"

namespace assay::stats {

Evidence distance_evidence(const DistanceTest& test) {
  const auto interval = [test](double confidence) -> Interval {
    check::inside_unit({"distance_evidence", "confidence"}, confidence);
    const double log_tail = std::log((1 - confidence) / 2);
    const auto end = [&](const Curve& excess) {
      if (excess(0) >= 0) return 0.0;
      double high = std::min(test.start, test.largest);
      while (excess(high) < 0) {
        if (high == test.largest) return test.beyond;
        high = std::min(2 * high, test.largest);
      }
      return root(excess, {0, high}, 44);
    };
    if (test.at(0).log_p_lower < log_tail) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      return {none, none, confidence};
    }
    return {end([&](double theta) { return test.at(theta).log_p_upper - log_tail; }),
            end([&](double theta) { return log_tail - test.at(theta).log_p_lower; }), confidence};
  };
  return {.estimate = test.estimate,
          .at = [test](double theta) { return theta > 0 ? test.at(theta) : test.equal; },
          .interval = interval,
          .quantity = test.quantity,
          .distance = true};
}

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
