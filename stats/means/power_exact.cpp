#include "stats/means/power_exact.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/planning/planning.h"

namespace assay::stats {
namespace {

constexpr std::uint64_t largest_size = std::uint64_t{1} << 40;

// The plan with the effect above the null value. An effect below it is mirrored.
struct Upward {
  double sign;
  Range range;
  double null_mean;  // The nearer end of the allowed range.
  double mean;       // With the effect.
  double log_level;

  bool is_impossible() const {
    return null_mean < range.low || null_mean > range.high || mean > range.high;
  }
};

Upward upward(const char* function, const ExactMeanPlan& plan, double effect) {
  planning::check_rates(function, plan.rates);
  check::non_negative({function, "allow"}, plan.allow);
  check::finite({function, "effect"}, effect);
  if (effect == 0) check::fail({function, "effect"}, effect, "not 0");
  const bool mirrored = effect < 0;
  const Range range = mirrored ? Range{-plan.range.high, -plan.range.low} : plan.range;
  const double null = mirrored ? -plan.null_mean : plan.null_mean;
  return {mirrored ? -1.0 : 1.0, range, null + plan.allow, null + std::abs(effect),
          planning::critical_tail(plan.rates).log_probability};
}

// ---- Binomial

double probability(const Upward& plan, double mean) {
  return (mean - plan.range.low) / (plan.range.high - plan.range.low);
}

// The least count whose upper tail under p is at most the level; n + 1 if there is none.
std::uint64_t critical_count(std::uint64_t n, double p, double log_level) {
  // A count of 0 is never rejected: its tail is the whole.
  return smallest_whole(1, n + 1, [&](std::uint64_t count) {
    return binomial_upper(count, {n, p}) <= log_level;
  });
}

double binomial_power(const ExactMeanPlan& plan, std::uint64_t n, double effect) {
  check::at_least({"binomial_power", "n"}, n, 1);
  const Upward up = upward("binomial_power", plan, effect);
  if (up.is_impossible()) return 1;
  const std::uint64_t critical = critical_count(n, probability(up, up.null_mean), up.log_level);
  if (critical > n) return 0;
  return std::exp(binomial_upper(critical, {n, probability(up, up.mean)}));
}

std::optional<std::uint64_t> binomial_size(const ExactMeanPlan& plan, double effect) {
  const auto enough_at = [&](std::uint64_t n) {
    return binomial_power(plan, n, effect) >= 1 - plan.rates.beta;
  };
  const auto enough = [&](std::uint64_t n) { return enough_at(n) && enough_at(2 * n); };
  std::uint64_t missed = 1;
  std::uint64_t found = 2;
  while (!enough(found)) {
    if (found >= largest_size) return std::nullopt;
    missed = found;
    found *= 2;
  }
  while (found - missed > 1 + missed / 256) {
    const std::uint64_t middle = missed + (found - missed) / 2;
    (enough(middle) ? found : missed) = middle;
  }
  return found;
}

// ---- Bets

// ln of the wealth at which a mixture with this bet rejects.
double log_goal(const Upward& up) {
  return std::log(static_cast<double>(bet_count)) - up.log_level;
}

std::vector<BetGrowth> growths(const ExactMeanPlan& plan, const Upward& up) {
  std::vector<BetGrowth> each;
  if (!std::isfinite(up.range.low)) return each;
  const MovedLaw law{*plan.law, up.sign, up.mean - up.null_mean, up.null_mean - up.range.low};
  for (std::size_t k = 0; k < bet_count; ++k) each.push_back(bet_growth(law, k));
  return each;
}

double betting_power(const ExactMeanPlan& plan, std::uint64_t n, double effect) {
  check::at_least({"betting_power", "n"}, n, 1);
  const Upward up = upward("betting_power", plan, effect);
  if (up.is_impossible() || up.null_mean == up.range.low) return 1;
  const double count = static_cast<double>(n);
  double largest = 0;
  for (const BetGrowth& growth : growths(plan, up)) {
    const double beyond = count * growth.mean - log_goal(up);
    const double spread = std::sqrt(count * growth.variance);
    const double power =
        spread > 0 ? std::exp(normal_tails(beyond / spread).lower) : (beyond >= 0 ? 1 : 0);
    largest = std::max(largest, power);
  }
  return largest;
}

// sqrt n solves n mean - z sqrt(n variance) = goal for the bet that is first.
std::optional<std::uint64_t> betting_size(const ExactMeanPlan& plan, double effect) {
  const Upward up = upward("betting_size", plan, effect);
  if (up.is_impossible() || up.null_mean == up.range.low) return 1;
  const double z = upper_normal_quantile(plan.rates.beta);
  double least = static_cast<double>(largest_size);
  for (const BetGrowth& growth : growths(plan, up)) {
    if (!(growth.mean > 0)) continue;
    const double b = z * std::sqrt(growth.variance);
    const double root = (b + std::sqrt(b * b + 4 * growth.mean * log_goal(up))) / (2 * growth.mean);
    least = std::min(least, std::ceil(root * root));
  }
  if (!(least < static_cast<double>(largest_size))) return std::nullopt;
  return static_cast<std::uint64_t>(std::max(1.0, least));
}

}  // namespace

const ExactPlanning binomial_planning{binomial_power, binomial_size};
const ExactPlanning betting_planning{betting_power, betting_size};

std::optional<std::uint64_t> exact_sample_size(const ExactPlanning& method,
                                               const ExactMeanPlan& claimed, double effect) {
  const double edge = std::copysign(claimed.allow, effect);
  ExactMeanPlan forbidden = claimed;
  forbidden.null_mean += effect;
  forbidden.allow = 0;
  forbidden.rates = {.alpha = claimed.rates.beta, .beta = claimed.rates.beta, .two_sided = false};
  const auto rejects = method.sample_size(claimed, effect);
  if (!rejects) return std::nullopt;
  // An end of the range that is infinite lets no number pass.
  return std::max(*rejects, method.sample_size(forbidden, edge - effect).value_or(0));
}

std::optional<double> exact_detectable(const ExactPlanning& method, const ExactMeanPlan& plan,
                                       std::uint64_t n, int side) {
  const double room = side > 0 ? plan.range.high - plan.null_mean : plan.null_mean - plan.range.low;
  const auto finds = [&](double effect) {
    return method.power(plan, n, side * effect) >= 1 - plan.rates.beta;
  };
  if (!(room > plan.allow)) return std::nullopt;
  // Without an end the search begins at the distance to the other.
  double found = room;
  if (!std::isfinite(room)) {
    found = side > 0 ? plan.null_mean - plan.range.low : plan.range.high - plan.null_mean;
    for (int i = 0; i < 60 && !finds(found); ++i) found *= 2;
  }
  if (!std::isfinite(found) || !finds(found)) return std::nullopt;
  return halved_between(plan.allow, found, finds).outside;
}

}  // namespace assay::stats
