#pragma once

// The data's evidence about theta, the number that a claim is about: tests of every value in both
// directions, and an interval. Verdicts are made of nothing else.

#include <functional>
#include <string>
#include <utility>

#include "stats/means/binomial.h"
#include "stats/tails/test_result.h"

namespace assay::harness {

struct Evidence {
  double estimate = 0;
  /// Tests "theta is this value". log_p_upper is the p-value of "theta <= value", log_p_lower that
  /// of "theta >= value".
  std::function<stats::TestResult(double)> at;
  /// Two-sided interval of theta.
  std::function<stats::Interval(double)> interval;
  /// The part of the data that speaks most against "theta <= value", in words. Unset if the data
  /// have no parts.
  std::function<std::string(double)> most_against = {};
  std::string quantity;   ///< Name of theta.
  bool relative = false;  ///< Shown in per cent.
  bool distance = false;  ///< Theta cannot be negative: `==` has one direction.
  bool exact = false;     ///< The estimate has no error, as with costs that never vary.
};

/// Evidence about theta = q + offset, where q is the probability of a success. The offset may be
/// off by `error`. Exact binomial tests at both ends of the error, and Clopper and Pearson's
/// interval.
Evidence from_probability(const stats::Successes& seen, double offset, double error = 0);

/// Evidence about |theta|, a distance.
Evidence absolute(const Evidence& of_theta);

/// A part that is the same for every value.
inline std::function<std::string(double)> always(std::string part) {
  return [part = std::move(part)](double) { return part; };
}

/// A rough location of an interval.
struct Whereabouts {
  double estimate = 0;
  double step = 1;  ///< About a standard error.
};

/// The values of theta that `at` rejects in neither tail at (1 - confidence) / 2. The ends are
/// exact to 1e-12 of their distance from the estimate. An end beyond 60 doublings of the step is
/// infinite. `at` must be monotone: its upper tail rejects larger values less.
stats::Interval interval_by_inversion(const std::function<stats::TestResult(double)>& at,
                                      const Whereabouts& around, double confidence);

/// The interval of a monotone function of the number, rising or falling.
stats::Interval map_ends(const stats::Interval& interval, const std::function<double(double)>& map);

}  // namespace assay::harness
