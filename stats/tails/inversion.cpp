#include "stats/tails/inversion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/basics/search.h"

namespace assay::stats {
namespace {

constexpr int most_doublings = 60;
constexpr unsigned digits_of_reach = 40;

// The end in one direction of the values at which a curve is positive.
double end_of(const Curve& curve, const Whereabouts& around, double direction) {
  const auto at = [&](double reach) { return curve(around.estimate + direction * reach); };
  double inside = 0;
  double outside = around.step;
  for (int doublings = 0; at(outside) > 0; outside *= 2) {
    inside = outside;
    if (++doublings == most_doublings) return direction * std::numeric_limits<double>::infinity();
  }
  if (!(inside > 0 || at(inside) > 0)) return around.estimate;
  return around.estimate + direction * root_bracket(at, inside, outside, digits_of_reach).first;
}

}  // namespace

Interval interval_by_inversion(const std::function<TestResult(double)>& at,
                               const Whereabouts& around, double confidence) {
  const double level = std::log((1 - confidence) / 2);
  const auto above = [&](double theta) { return at(theta).log_p_lower - level; };
  const auto below = [&](double theta) { return at(theta).log_p_upper - level; };
  return {end_of(below, around, -1), end_of(above, around, 1), confidence};
}

Interval map_ends(const Interval& interval, const std::function<double(double)>& map) {
  const double one = map(interval.low);
  const double other = map(interval.high);
  return {std::min(one, other), std::max(one, other), interval.confidence};
}

}  // namespace assay::stats
