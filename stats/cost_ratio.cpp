#include "stats/cost_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/check.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

struct LogMean {
  double value;
  double variance;
};

LogMean log_mean(const char* function, const Moments& cost) {
  check::at_least({function, "count"}, cost.count, 2);
  check::positive({function, "mean cost"}, cost.mean);
  const double relative = cost.standard_error() / cost.mean;
  return {std::log(cost.mean), relative * relative};
}

// Both sides of an exact comparison: nothing against what holds, everything against what does not.
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

TestResult normal_result(double z) {
  const LogTails tails = normal_tails(z);
  return {z, {"normal", {}}, tails.lower, tails.upper, Exactness::asymptotic};
}

Interval normal_interval(LogMean mean, double confidence) {
  const double half =
      normal_quantile({Tail::upper, std::log((1 - confidence) / 2)}) * std::sqrt(mean.variance);
  return {mean.value - half, mean.value + half, confidence};
}

}  // namespace

TestResult log_cost_ratio(const Moments& cost_x, const Moments& cost_y, double null_ratio) {
  check::positive({"log_cost_ratio", "null_ratio"}, null_ratio);
  const LogMean x = log_mean("log_cost_ratio", cost_x);
  const LogMean y = log_mean("log_cost_ratio", cost_y);
  const double variance = x.variance + y.variance;
  if (variance == 0) return deterministic(cost_x.mean, null_ratio * cost_y.mean);
  return normal_result((x.value - y.value - std::log(null_ratio)) / std::sqrt(variance));
}

Interval log_cost_ratio_interval(const Moments& cost_x, const Moments& cost_y, double confidence) {
  check::inside_unit({"log_cost_ratio_interval", "confidence"}, confidence);
  const LogMean x = log_mean("log_cost_ratio_interval", cost_x);
  const LogMean y = log_mean("log_cost_ratio_interval", cost_y);
  return normal_interval({x.value - y.value, x.variance + y.variance}, confidence);
}

TestResult log_cost(const Moments& cost, double null_cost) {
  check::positive({"log_cost", "null_cost"}, null_cost);
  const LogMean mean = log_mean("log_cost", cost);
  if (mean.variance == 0) return deterministic(cost.mean, null_cost);
  return normal_result((mean.value - std::log(null_cost)) / std::sqrt(mean.variance));
}

Interval log_cost_interval(const Moments& cost, double reference_cost, double confidence) {
  check::positive({"log_cost_interval", "reference_cost"}, reference_cost);
  check::inside_unit({"log_cost_interval", "confidence"}, confidence);
  LogMean mean = log_mean("log_cost_interval", cost);
  mean.value -= std::log(reference_cost);
  return normal_interval(mean, confidence);
}

double log_cost_sample_size(const CostPlan& plan, double detect) {
  check::non_negative({"log_cost_sample_size", "variation_x"}, plan.variation_x);
  check::non_negative({"log_cost_sample_size", "variation_y"}, plan.variation_y);
  check::positive({"log_cost_sample_size", "allow"}, plan.allow);
  check::positive({"log_cost_sample_size", "detect"}, detect);
  return normal_sample_size(std::hypot(plan.variation_x, plan.variation_y),
                            {std::log(plan.allow), std::log(detect)}, plan.rates);
}

}  // namespace assay::stats
