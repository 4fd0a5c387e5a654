#include "stats/variances/cost_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/basics/check.h"
#include "stats/gates/normal_test.h"

namespace assay::stats {
namespace {

NormalEstimate log_mean(const char* function, const Moments& cost) {
  check::at_least({function, "count"}, cost.count, 2);
  check::positive({function, "mean cost"}, cost.mean);
  return {std::log(cost.mean), cost.standard_error() / cost.mean};
}

NormalEstimate log_ratio(const char* function, const Moments& cost_x, const Moments& cost_y) {
  const NormalEstimate x = log_mean(function, cost_x);
  const NormalEstimate y = log_mean(function, cost_y);
  return {x.value - y.value, std::hypot(x.standard_error, y.standard_error)};
}

// An exact comparison: no evidence against equal numbers, certainty against others.
TestResult deterministic(double cost, double claimed) {
  constexpr double impossible = std::numeric_limits<double>::lowest();
  const bool equal = std::abs(cost - claimed) <= cost_rounding * std::max(cost, claimed);
  const double difference = equal ? 0 : cost - claimed;
  return {difference,
          {"bound", {}},
          difference < 0 ? impossible : 0,
          difference > 0 ? impossible : 0,
          Exactness::exact};
}

}  // namespace

TestResult log_cost_ratio(const Moments& cost_x, const Moments& cost_y, double null_ratio) {
  check::positive({"log_cost_ratio", "null_ratio"}, null_ratio);
  const NormalEstimate ratio = log_ratio("log_cost_ratio", cost_x, cost_y);
  if (ratio.standard_error == 0) return deterministic(cost_x.mean, null_ratio * cost_y.mean);
  return normal_test({ratio.value - std::log(null_ratio), ratio.standard_error});
}

Interval log_cost_ratio_interval(const Moments& cost_x, const Moments& cost_y, double confidence) {
  check::inside_unit({"log_cost_ratio_interval", "confidence"}, confidence);
  return normal_interval(log_ratio("log_cost_ratio_interval", cost_x, cost_y), confidence);
}

TestResult log_cost(const Moments& cost, double null_cost) {
  check::positive({"log_cost", "null_cost"}, null_cost);
  const NormalEstimate mean = log_mean("log_cost", cost);
  if (mean.standard_error == 0) return deterministic(cost.mean, null_cost);
  return normal_test({mean.value - std::log(null_cost), mean.standard_error});
}

Interval log_cost_interval(const Moments& cost, double reference_cost, double confidence) {
  check::positive({"log_cost_interval", "reference_cost"}, reference_cost);
  check::inside_unit({"log_cost_interval", "confidence"}, confidence);
  NormalEstimate mean = log_mean("log_cost_interval", cost);
  mean.value -= std::log(reference_cost);
  return normal_interval(mean, confidence);
}

}  // namespace assay::stats
