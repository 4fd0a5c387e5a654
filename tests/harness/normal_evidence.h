#pragma once

#include "harness/theta/decision.h"
#include "stats/tails/tails.h"

namespace assay::harness {

/// Evidence of an estimate of theta that is normal with a known standard error.
inline Evidence normal_evidence(double estimate, double standard_error) {
  return {.estimate = estimate,
          .at =
              [=](double theta) {
                const double z = (estimate - theta) / standard_error;
                const stats::LogTails tails = stats::normal_tails(z);
                return stats::TestResult{.statistic = z,
                                         .distribution = {.family = "normal", .parameters = {}},
                                         .log_p_lower = tails.lower,
                                         .log_p_upper = tails.upper};
              },
          .interval =
              [=](double confidence) {
                const double reach =
                    standard_error *
                    stats::normal_quantile({stats::Tail::upper, std::log((1 - confidence) / 2)});
                return stats::Interval{estimate - reach, estimate + reach, confidence};
              },
          .quantity = "difference"};
}

}  // namespace assay::harness
