#include "harness/theta/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stats/basics/search.h"

namespace assay::harness {
namespace {

constexpr int most_doublings = 60;
constexpr unsigned digits_of_reach = 40;

/// The end in one direction of the values at which a curve is positive.
double end_of(const stats::Curve& curve, const Whereabouts& around, double direction) {
  const auto at = [&](double reach) { return curve(around.estimate + direction * reach); };
  double inside = 0;
  double outside = around.step;
  for (int doublings = 0; at(outside) > 0; outside *= 2) {
    inside = outside;
    if (++doublings == most_doublings) return direction * std::numeric_limits<double>::infinity();
  }
  if (!(inside > 0 || at(inside) > 0)) return around.estimate;
  return around.estimate +
         direction * stats::root_bracket(at, inside, outside, digits_of_reach).first;
}

constexpr double log_of_impossible = std::numeric_limits<double>::lowest();

/// log_p_upper of "q is at most `most`"; no probability is below 0.
double log_p_at_most(const stats::Successes& seen, double most) {
  return most < 0 ? log_of_impossible : stats::binomial(seen, std::min(most, 1.0)).log_p_upper;
}

double log_p_at_least(const stats::Successes& seen, double least) {
  return least > 1 ? log_of_impossible : stats::binomial(seen, std::max(least, 0.0)).log_p_lower;
}

}  // namespace

Evidence from_probability(const stats::Successes& seen, double offset, double error) {
  const auto successes = static_cast<double>(seen.successes);
  const auto trials = static_cast<double>(seen.trials);
  const auto at = [=](double theta) {
    const double q = theta - offset;
    return stats::TestResult{
        .statistic = successes,
        .distribution = {.family = "binomial", .parameters = {trials, std::clamp(q, 0.0, 1.0)}},
        .log_p_lower = log_p_at_least(seen, q - error),
        .log_p_upper = log_p_at_most(seen, q + error)};
  };
  const auto interval = [=](double confidence) -> stats::Interval {
    const stats::Interval q = stats::clopper_pearson(seen, confidence);
    return {q.low + offset - error, q.high + offset + error, confidence};
  };
  return {.estimate = successes / trials + offset, .at = at, .interval = interval};
}

Evidence absolute(const Evidence& of_theta) {
  const auto at = [at = of_theta.at](double theta) {
    const stats::TestResult above = at(theta);
    const stats::TestResult below = at(-theta);
    stats::TestResult result = above;
    result.log_p_upper =
        std::min(0.0, std::numbers::ln2 + std::min(above.log_p_upper, below.log_p_lower));
    result.log_p_lower = std::max(above.log_p_lower, below.log_p_upper);
    return result;
  };
  const auto interval = [interval = of_theta.interval](double confidence) -> stats::Interval {
    const stats::Interval of = interval(confidence);
    return {std::max({0.0, of.low, -of.high}), std::max(std::abs(of.low), std::abs(of.high)),
            confidence};
  };
  return {.estimate = std::abs(of_theta.estimate), .at = at, .interval = interval};
}

stats::Interval interval_by_inversion(const std::function<stats::TestResult(double)>& at,
                                      const Whereabouts& around, double confidence) {
  const double level = std::log((1 - confidence) / 2);
  const auto above = [&](double theta) { return at(theta).log_p_lower - level; };
  const auto below = [&](double theta) { return at(theta).log_p_upper - level; };
  return {end_of(below, around, -1), end_of(above, around, 1), confidence};
}

stats::Interval map_ends(const stats::Interval& interval,
                         const std::function<double(double)>& map) {
  const double one = map(interval.low);
  const double other = map(interval.high);
  return {std::min(one, other), std::max(one, other), interval.confidence};
}

}  // namespace assay::harness
