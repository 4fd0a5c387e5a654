#include <cmath>

#include "stats/planning/planning.h"
#include "stats/planning/power.h"

namespace assay::stats {
namespace {

using planning::z_upper;

void check_size(const char* function, double n) {
  if (!(n > 1) || !std::isfinite(n)) check::fail({function, "n"}, n, "above 1 and finite");
}

void check_plan(const char* function, const LogVariancePlan& plan) {
  planning::check_rates(function, plan.rates);
  for (const double kurtosis : {plan.kurtosis_x, plan.kurtosis_y}) {
    if (!(kurtosis >= 1) || std::isinf(kurtosis)) {
      check::fail({function, "kurtosis"}, kurtosis, "at least 1 and finite");
    }
  }
  if (!(plan.kurtosis_x + plan.kurtosis_y > 2)) {
    check::fail({function, "kurtosis_x"}, plan.kurtosis_x, "above 1 for one sample at least");
  }
  check::positive({function, "allocation"}, plan.allocation);
  check::finite({function, "allow"}, plan.allow);
  if (!(plan.allow >= 1)) check::fail({function, "allow"}, plan.allow, "a ratio of at least 1");
}

double log_spread(const LogVariancePlan& plan) {
  return (plan.kurtosis_x - 1) + (plan.kurtosis_y - 1) / plan.allocation;
}

// n = 1 + spread ((z_alpha + z_beta) / ln(detect / allow))^2.
double guess_size(const LogVariancePlan& plan, double detect) {
  const double gap = std::log(detect) - std::log(plan.allow);
  const double z = normal_quantile(planning::critical_tail(plan.rates)) + z_upper(plan.rates.beta);
  return 1 + log_spread(plan) * (z / gap) * (z / gap);
}

double log_power_of(const LogVariancePlan& plan, double n, double log_ratio) {
  const double error = std::sqrt(log_spread(plan) / n);
  const double z = normal_quantile(planning::critical_tail(plan.rates));
  const double margin = std::log(plan.allow);
  double power = std::exp(normal_tails((log_ratio - margin) / error - z).lower);
  if (plan.rates.two_sided)
    power += std::exp(normal_tails((-log_ratio - margin) / error - z).lower);
  return std::min(power, 1.0);
}

}  // namespace

double log_variance_power(const LogVariancePlan& plan, double n, double ratio) {
  check_plan("log_variance_power", plan);
  check_size("log_variance_power", n);
  check::positive({"log_variance_power", "ratio"}, ratio);
  return log_power_of(plan, n, std::log(ratio));
}

double log_variance_detectable(const LogVariancePlan& plan, double n) {
  check_plan("log_variance_detectable", plan);
  check_size("log_variance_detectable", n);
  const auto enough = [&](double log_ratio) {
    return log_power_of(plan, n, log_ratio) >= 1 - plan.rates.beta;
  };
  return std::exp(planning::smallest_effect(enough, std::log(plan.allow), 0.01));
}

std::optional<std::uint64_t> log_variance_sample_size(const LogVariancePlan& plan, double detect) {
  check_plan("log_variance_sample_size", plan);
  check::positive({"log_variance_sample_size", "detect"}, detect);
  if (!(detect > plan.allow)) {
    check::fail({"log_variance_sample_size", "detect"}, detect, "above allow");
  }
  const double guess = guess_size(plan, detect);
  if (guess > planning::most_samples) return std::nullopt;
  const auto enough = [&](double n) {
    return log_power_of(plan, n, std::log(detect)) >= 1 - plan.rates.beta;
  };
  return planning::smallest_sample(enough, guess, 4);
}

}  // namespace assay::stats
