#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "stats/basics/search.h"
#include "stats/planning/planning.h"
#include "stats/planning/power.h"
#include "stats/tails/kolmogorov.h"

namespace assay::stats {
namespace {

void check_plan(const char* function, const DistancePlan& plan) {
  planning::check_rates(function, plan.rates);
  if (!(plan.allow >= 0 && plan.allow < 1)) {
    check::fail({function, "allow"}, plan.allow, "in [0, 1)");
  }
  check::positive({function, "allocation"}, plan.allocation);
}

TwoSizes sizes_of(const DistancePlan& plan, double n) {
  const auto second = static_cast<std::uint64_t>(std::max(1.0, std::round(n * plan.allocation)));
  return {static_cast<std::uint64_t>(n), second};
}

// Smallest lattice distance of two samples that the law rejects, a step beyond 1 if there is none.
double two_sample_critical(double log_alpha, TwoSizes sizes) {
  const std::uint64_t steps = std::lcm(sizes.m, sizes.n);
  const std::uint64_t critical = smallest_whole(1, steps + 1, [&](std::uint64_t step) {
    return smirnov_upper_tail({step, sizes.m, sizes.n}) <= log_alpha;
  });
  return static_cast<double>(critical) / static_cast<double>(steps);
}

double two_sample_margin_critical(double log_alpha, TwoSizes sizes) {
  const auto excess = [&](double gap) { return log_alpha - log_two_suprema_bound(gap, sizes); };
  double high = 1;
  while (excess(high) < 0) high *= 2;
  return root_bracket(excess, 0, high, 30).second;
}

// d_alpha: the distance above `allow` from which the test rejects.
double found_critical_distance(const DistancePlan& plan, double n) {
  const TwoSizes sizes = sizes_of(plan, n);
  const double log_alpha = std::log(plan.rates.alpha);
  if (!plan.two_samples) return kolmogorov_upper_quantile(log_alpha, sizes.m);
  return plan.allow == 0 ? two_sample_critical(log_alpha, sizes)
                         : two_sample_margin_critical(log_alpha, sizes);
}

// The same with the last answer kept. One takes up to milliseconds, and the detectable distance and
// the power ask for it in a row.
double critical_distance(const DistancePlan& plan, double n) {
  using Key = std::tuple<double, bool, bool, double, double>;
  thread_local std::optional<std::pair<Key, double>> last;
  const Key key{plan.rates.alpha, plan.two_samples, plan.allow == 0, n, plan.allocation};
  if (!last || last->first != key) last = {key, found_critical_distance(plan, n)};
  return last->second;
}

// The equivalent number of observations of one sample: m n / (m + n) of two.
double effective(const DistancePlan& plan, double n) {
  return plan.two_samples ? n * plan.allocation / (1 + plan.allocation) : n;
}

void check_size(const char* function, double n) {
  if (!(n >= 1) || n > planning::most_samples) check::fail({function, "n"}, n, "in [1, 2^53]");
}

double power_bound(const DistancePlan& plan, double n, double distance) {
  const double gap = distance - plan.allow - critical_distance(plan, n);
  return gap > 0 ? -std::expm1(-2 * effective(plan, n) * gap * gap) : 0;
}

void check_plan(const char* function, const FitPlan& plan) {
  planning::check_rates(function, plan.rates);
  check::positive({function, "degrees_of_freedom"}, plan.degrees_of_freedom);
  check::non_negative({function, "allow"}, plan.allow);
}

// The power of a fit of n observations as a function of the effect.
auto fit_power(const FitPlan& plan, double n) {
  const auto law = [degrees = plan.degrees_of_freedom, n](double effect) {
    return Noncentral{degrees, n * effect * effect};
  };
  const double critical =
      noncentral_chi_square_quantile({Tail::upper, std::log(plan.rates.alpha)}, law(plan.allow));
  return [law, critical](double effect) {
    return std::exp(noncentral_chi_square_tails(critical, law(effect)).upper);
  };
}

}  // namespace

double ks_power_bound(const DistancePlan& plan, double n, double distance) {
  check_plan("ks_power_bound", plan);
  check::unit({"ks_power_bound", "distance"}, distance);
  check_size("ks_power_bound", n);
  return power_bound(plan, std::floor(n), distance);
}

double ks_detectable(const DistancePlan& plan, double n) {
  check_plan("ks_detectable", plan);
  check_size("ks_detectable", n);
  const double size = std::floor(n);
  const double miss = std::sqrt(-std::log(plan.rates.beta) / (2 * effective(plan, size)));
  const double distance = plan.allow + critical_distance(plan, size) + miss;
  return distance <= 1 ? distance : std::numeric_limits<double>::infinity();
}

std::optional<std::uint64_t> ks_sample_size(const DistancePlan& plan, double detect) {
  check_plan("ks_sample_size", plan);
  planning::check_effect("ks_sample_size", plan.allow, detect);
  check::unit({"ks_sample_size", "detect"}, detect);
  const double scale = plan.two_samples ? (1 + plan.allocation) / plan.allocation : 1;
  const double root =
      std::sqrt(std::log(2 / plan.rates.alpha) / 2) + std::sqrt(-std::log(plan.rates.beta) / 2);
  const double gap = detect - plan.allow;
  const double guess = scale * (root / gap) * (root / gap);
  if (guess > planning::most_samples) return std::nullopt;
  // Massart's bound replaces d_alpha, whose quantile takes milliseconds. It is at least d_alpha, so
  // the size suffices and is a few in a thousand too large.
  if (!plan.two_samples) return static_cast<std::uint64_t>(std::ceil(guess));
  const auto enough = [&](double n) { return power_bound(plan, n, detect) >= 1 - plan.rates.beta; };
  return planning::smallest_sample(enough, guess, 1);
}

double chi_square_fit_power(const FitPlan& plan, double n, double effect) {
  check_plan("chi_square_fit_power", plan);
  check_size("chi_square_fit_power", n);
  check::non_negative({"chi_square_fit_power", "effect"}, effect);
  return fit_power(plan, n)(effect);
}

double chi_square_fit_detectable(const FitPlan& plan, double n) {
  check_plan("chi_square_fit_detectable", plan);
  check_size("chi_square_fit_detectable", n);
  return planning::smallest_effect(fit_power(plan, n), 1 - plan.rates.beta, plan.allow,
                                   1 / std::sqrt(n));
}

std::optional<std::uint64_t> chi_square_fit_sample_size(const FitPlan& plan, double detect) {
  check_plan("chi_square_fit_sample_size", plan);
  planning::check_effect("chi_square_fit_sample_size", plan.allow, detect);
  const double z = upper_normal_quantile(plan.rates.alpha) + upper_normal_quantile(plan.rates.beta);
  const double gap = detect - plan.allow;
  const double guess = (z * z + z * std::sqrt(2 * plan.degrees_of_freedom)) / (gap * gap);
  if (guess > planning::most_samples) return std::nullopt;
  const auto enough = [&](double n) { return fit_power(plan, n)(detect) >= 1 - plan.rates.beta; };
  return planning::smallest_sample(enough, guess, 1);
}

}  // namespace assay::stats
