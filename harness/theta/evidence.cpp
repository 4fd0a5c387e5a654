#include "harness/theta/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace assay::harness {
namespace {

constexpr int most_doublings = 60;
constexpr double precision = 1e-12;

/// The end of the kept values in one direction.
double end_of(const std::function<bool(double)>& kept, const Whereabouts& around,
              double direction) {
  double inside = around.estimate;
  double reach = around.step;
  int doublings = 0;
  while (kept(around.estimate + direction * reach)) {
    inside = around.estimate + direction * reach;
    reach *= 2;
    if (++doublings == most_doublings) return direction * std::numeric_limits<double>::infinity();
  }
  double outside = around.estimate + direction * reach;
  while (std::abs(outside - inside) > precision * around.step) {
    const double middle = inside + (outside - inside) / 2;
    if (middle == inside || middle == outside) break;
    (kept(middle) ? inside : outside) = middle;
  }
  return inside;
}

}  // namespace

stats::Interval interval_by_inversion(const std::function<stats::TestResult(double)>& at,
                                      const Whereabouts& around, double confidence) {
  const double level = std::log((1 - confidence) / 2);
  const auto above = [&](double theta) { return at(theta).log_p_lower > level; };
  const auto below = [&](double theta) { return at(theta).log_p_upper > level; };
  return {end_of(below, around, -1), end_of(above, around, 1), confidence};
}

stats::Interval map_ends(const stats::Interval& interval,
                         const std::function<double(double)>& map) {
  const double one = map(interval.low);
  const double other = map(interval.high);
  return {std::min(one, other), std::max(one, other), interval.confidence};
}

}  // namespace assay::harness
