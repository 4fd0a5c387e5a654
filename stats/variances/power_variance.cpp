#include <cmath>

#include "stats/planning/planning.h"
#include "stats/planning/power.h"

namespace assay::stats {
namespace {

using planning::log_tail_level;
using planning::z_upper;

// Quantiles and tails of the statistic over the true ratio: chi-square / nu or F.
struct ChiSquareLaw {
  double degrees;

  double quantile(LogTail tail) const { return chi_square_quantile(tail, degrees); }
  LogTails tails(double x) const { return chi_square_tails(x, degrees); }
};

struct FLaw {
  FDegrees degrees;

  double quantile(LogTail tail) const { return f_quantile(tail, degrees); }
  LogTails tails(double x) const { return f_tails(x, degrees); }
};

template <class Law>
double power_of(const Law& law, const VariancePlan& plan, double ratio) {
  const double level = log_tail_level(plan.rates);
  const bool above = plan.rates.two_sided || !plan.below;
  const bool below = plan.rates.two_sided || plan.below;
  double power = 0;
  if (above) {
    power += std::exp(law.tails(law.quantile({Tail::upper, level}) * plan.allow / ratio).upper);
  }
  if (below) {
    power += std::exp(law.tails(law.quantile({Tail::lower, level}) / (plan.allow * ratio)).lower);
  }
  return std::min(power, 1.0);
}

void check_plan(const char* function, const VariancePlan& plan) {
  planning::check_rates(function, plan.rates);
  check::finite({function, "allow"}, plan.allow);
  if (!(plan.allow >= 1)) check::fail({function, "allow"}, plan.allow, "a ratio of at least 1");
}

void check_size(const char* function, double n) {
  if (!(n > 1) || !std::isfinite(n)) check::fail({function, "n"}, n, "above 1 and finite");
}

void check_detect(const char* function, const VariancePlan& plan, double detect) {
  check::positive({function, "detect"}, detect);
  const double size = plan.below ? 1 / detect : detect;
  if (!(size > plan.allow)) check::fail({function, "detect"}, detect, "beyond allow");
}

// The detectable ratio on the planned side, searched in the logarithm.
template <class Law>
double detectable(const Law& law, const VariancePlan& plan) {
  const auto ratio_of = [&](double log_effect) {
    return std::exp(plan.below ? -log_effect : log_effect);
  };
  const auto enough = [&](double log_effect) {
    return log_effect > 600 || power_of(law, plan, ratio_of(log_effect)) >= 1 - plan.rates.beta;
  };
  const double found = planning::smallest_effect(enough, std::log(plan.allow), 0.01);
  if (found >= 600) return plan.below ? 0 : std::numeric_limits<double>::infinity();
  return ratio_of(found);
}

// n = 1 + spread ((z_alpha + z_beta) / ln(detect / allow))^2, spread = 2 for each sample.
double guess_size(const VariancePlan& plan, double detect, double spread) {
  const double gap = std::abs(std::log(detect)) - std::log(plan.allow);
  const double z = normal_quantile(planning::critical_tail(plan.rates)) + z_upper(plan.rates.beta);
  return 1 + spread * (z / gap) * (z / gap);
}

FLaw f_law(SampleSizes sizes) { return {{sizes.x - 1, sizes.y - 1}}; }

void check_sizes(const char* function, SampleSizes sizes) {
  check_size(function, sizes.x);
  check_size(function, sizes.y);
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

double chi_square_variance_power(const VariancePlan& plan, double n, double ratio) {
  check_plan("chi_square_variance_power", plan);
  check_size("chi_square_variance_power", n);
  check::positive({"chi_square_variance_power", "ratio"}, ratio);
  return power_of(ChiSquareLaw{n - 1}, plan, ratio);
}

double chi_square_variance_detectable(const VariancePlan& plan, double n) {
  check_plan("chi_square_variance_detectable", plan);
  check_size("chi_square_variance_detectable", n);
  return detectable(ChiSquareLaw{n - 1}, plan);
}

std::optional<std::uint64_t> chi_square_variance_sample_size(const VariancePlan& plan,
                                                             double detect) {
  check_plan("chi_square_variance_sample_size", plan);
  check_detect("chi_square_variance_sample_size", plan, detect);
  const double guess = guess_size(plan, detect, 2);
  if (guess > planning::most_samples) return std::nullopt;
  const auto enough = [&](double n) {
    return power_of(ChiSquareLaw{n - 1}, plan, detect) >= 1 - plan.rates.beta;
  };
  return planning::smallest_sample(enough, guess, 2);
}

double f_ratio_power(const VariancePlan& plan, SampleSizes sizes, double ratio) {
  check_plan("f_ratio_power", plan);
  check_sizes("f_ratio_power", sizes);
  check::positive({"f_ratio_power", "ratio"}, ratio);
  return power_of(f_law(sizes), plan, ratio);
}

double f_ratio_detectable(const VariancePlan& plan, SampleSizes sizes) {
  check_plan("f_ratio_detectable", plan);
  check_sizes("f_ratio_detectable", sizes);
  return detectable(f_law(sizes), plan);
}

std::optional<std::uint64_t> f_ratio_sample_size(const VariancePlan& plan, double detect) {
  check_plan("f_ratio_sample_size", plan);
  check_detect("f_ratio_sample_size", plan, detect);
  const double guess = guess_size(plan, detect, 4);
  if (guess > planning::most_samples) return std::nullopt;
  const auto enough = [&](double n) {
    return power_of(f_law({n, n}), plan, detect) >= 1 - plan.rates.beta;
  };
  return planning::smallest_sample(enough, guess, 2);
}

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
  const double guess =
      guess_size({.allow = plan.allow, .rates = plan.rates}, detect, log_spread(plan));
  if (guess > planning::most_samples) return std::nullopt;
  const auto enough = [&](double n) {
    return log_power_of(plan, n, std::log(detect)) >= 1 - plan.rates.beta;
  };
  return planning::smallest_sample(enough, guess, 4);
}

}  // namespace assay::stats
