#include "harness/plan/critical.h"

#include <algorithm>
#include <cmath>

#include "harness/plan/looks.h"
#include "harness/theta/decision.h"
#include "stats/tails/tails.h"

namespace assay::harness {

double critical_value(double alpha, bool two_sided) {
  return stats::normal_quantile({stats::Tail::upper, std::log(two_sided ? alpha / 2 : alpha)});
}

double smallest_share(const Question& question, double share) {
  const TestEntry& test = *question.test;
  const bool planned = test.detect || test.claim.relation == Relation::within;
  return planned && !test.secondaries ? share / static_cast<double>(most_looks) : share;
}

double smallest_level(const Question& question, const FamilyPlace& place) {
  return smallest_share(question, place.share.alpha);
}

stats::ShapeLimits shape_limits(double critical) {
  const double log_tail = stats::normal_tails(critical).upper;
  const double nearer =
      stats::normal_quantile({stats::Tail::upper, log_tail + std::log(level_factor)});
  const double inflation = critical / nearer;
  return {.excess_kurtosis = std::min(0.2, 2 * (inflation * inflation - 1))};
}

}  // namespace assay::harness
