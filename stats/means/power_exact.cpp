#include "stats/means/power_exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/basics/check.h"
#include "stats/basics/moments.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// The plan with the effect above the null value. An effect below it is mirrored.
struct Upward {
  Range range;
  double null_mean;  // The nearer end of the allowed range.
  double mean;       // With the effect.
  double log_level;
};

Upward upward(const char* function, const ExactMeanPlan& plan, double effect) {
  check::inside_unit({function, "alpha"}, plan.rates.alpha);
  check::inside_unit({function, "beta"}, plan.rates.beta);
  check::non_negative({function, "allow"}, plan.allow);
  check::finite({function, "effect"}, effect);
  if (effect == 0) check::fail({function, "effect"}, effect, "not 0");
  const double level = plan.rates.two_sided ? plan.rates.alpha / 2 : plan.rates.alpha;
  const bool mirrored = effect < 0;
  const Range range = mirrored ? Range{-plan.range.high, -plan.range.low} : plan.range;
  const double null = mirrored ? -plan.null_mean : plan.null_mean;
  return {range, null + plan.allow, null + std::abs(effect), std::log(level)};
}

double probability(const Upward& plan, double mean) {
  return (mean - plan.range.low) / (plan.range.high - plan.range.low);
}

// The least count whose upper tail under p is at most the level; n + 1 if there is none.
std::uint64_t critical_count(std::uint64_t n, double p, double log_level) {
  // Never rejected: its tail is the whole.
  std::uint64_t kept = 0;
  std::uint64_t rejected = n + 1;
  while (rejected - kept > 1) {
    const std::uint64_t middle = kept + (rejected - kept) / 2;
    const bool rejects = binomial_upper(middle, {n, p}) <= log_level;
    (rejects ? rejected : kept) = middle;
  }
  return rejected;
}

Moments ideal(std::uint64_t n, double mean, double deviation) {
  Moments moments{.count = n, .mean = mean};
  moments.m2 = deviation * deviation * static_cast<double>(n - 1);
  moments.minimum = mean;
  moments.maximum = mean;
  return moments;
}

double critical_mean(const Upward& plan, std::uint64_t n, double deviation) {
  double kept = plan.null_mean;
  double rejected = plan.range.high;
  const auto rejects = [&](double mean) {
    return bounded_mean(ideal(n, mean, deviation), plan.range, plan.null_mean).log_p_upper <=
           plan.log_level;
  };
  if (!rejects(rejected)) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < 60; ++i) {
    const double middle = kept + (rejected - kept) / 2;
    (rejects(middle) ? rejected : kept) = middle;
  }
  return rejected;
}

// True if every sample mean rejects the null value at alpha or the effect at beta.
bool decides(const ExactMeanPlan& plan, std::uint64_t n, double effect) {
  const Upward up = upward("exact_sample_size", plan, effect);
  if (up.null_mean < up.range.low || up.mean > up.range.high) return true;
  const Upward back{{-up.range.high, -up.range.low}, -up.mean, 0, std::log(plan.rates.beta)};
  const double claimed = critical_mean(up, n, plan.standard_deviation);
  return claimed <= -critical_mean(back, n, plan.standard_deviation);
}

double power_of(ExactMethod method, const ExactMeanPlan& plan, std::uint64_t n, double effect) {
  return method == ExactMethod::binomial ? binomial_power(plan, n, effect)
                                         : bounded_power(plan, n, effect);
}

}  // namespace

double binomial_power(const ExactMeanPlan& plan, std::uint64_t n, double effect) {
  check::at_least({"binomial_power", "n"}, n, 1);
  const Upward up = upward("binomial_power", plan, effect);
  const double null = probability(up, up.null_mean);
  const double alternative = probability(up, up.mean);
  if (null < 0 || null > 1 || alternative < 0 || alternative > 1) return 1;
  const std::uint64_t critical = critical_count(n, null, up.log_level);
  if (critical > n) return 0;
  return std::exp(binomial_upper(critical, {n, alternative}));
}

double bounded_power(const ExactMeanPlan& plan, std::uint64_t n, double effect) {
  check::at_least({"bounded_power", "n"}, n, 2);
  check::non_negative({"bounded_power", "standard_deviation"}, plan.standard_deviation);
  const Upward up = upward("bounded_power", plan, effect);
  if (up.null_mean < up.range.low || up.null_mean > up.range.high || up.mean > up.range.high) {
    return 1;
  }
  const double critical = critical_mean(up, n, plan.standard_deviation);
  if (std::isinf(critical)) return 0;
  const double error = plan.standard_deviation / std::sqrt(static_cast<double>(n));
  if (error == 0) return up.mean >= critical ? 1 : 0;
  return std::exp(normal_tails((up.mean - critical) / error).lower);
}

std::optional<double> exact_detectable(ExactMethod method, const ExactMeanPlan& plan,
                                       std::uint64_t n, int side) {
  const double room = side > 0 ? plan.range.high - plan.null_mean : plan.null_mean - plan.range.low;
  const auto finds = [&](double effect) {
    return power_of(method, plan, n, side * effect) >= 1 - plan.rates.beta;
  };
  if (!(room > plan.allow) || !finds(room)) return std::nullopt;
  double missed = plan.allow;
  double found = room;
  for (int i = 0; i < 60; ++i) {
    const double middle = missed + (found - missed) / 2;
    (finds(middle) ? found : missed) = middle;
  }
  return found;
}

std::optional<std::uint64_t> exact_sample_size(ExactMethod method, const ExactMeanPlan& plan,
                                               double effect) {
  constexpr std::uint64_t most = std::uint64_t{1} << 40;
  const auto enough_at = [&](std::uint64_t n) {
    // For counts the two are the same.
    return method == ExactMethod::bounded ? decides(plan, n, effect)
                                          : binomial_power(plan, n, effect) >= 1 - plan.rates.beta;
  };
  const auto enough = [&](std::uint64_t n) { return enough_at(n) && enough_at(2 * n); };
  std::uint64_t missed = 1;  // Too few for a variance.
  std::uint64_t found = 2;
  while (!enough(found)) {
    if (found >= most) return std::nullopt;
    missed = found;
    found *= 2;
  }
  while (found - missed > 1 + missed / 256) {
    const std::uint64_t middle = missed + (found - missed) / 2;
    (enough(middle) ? found : missed) = middle;
  }
  return found;
}

}  // namespace assay::stats
