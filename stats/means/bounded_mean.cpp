#include "stats/means/bounded_mean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/tails/special.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// A mean on the unit scale, as its distances from both ends of the range. Near an end the nearer
// one keeps the digits.
struct UnitMean {
  double above_low = 0;
  double below_high = 0;

  UnitMean mirrored() const { return {below_high, above_low}; }
};

UnitMean unit_mean(double value, Range range) {
  const double width = range.high - range.low;
  return {(value - range.low) / width, (range.high - value) / width};
}

double difference(UnitMean a, UnitMean b) {
  return a.above_low < a.below_high ? a.above_low - b.above_low : b.below_high - a.below_high;
}

// The upper side is the lower side of 1 - x, so one set of formulas serves both.
struct UnitSample {
  double n = 0;
  UnitMean mean;
  double variance = 0;

  UnitSample mirrored() const { return {n, mean.mirrored(), variance}; }
};

UnitSample unit_sample(const char* function, const Moments& x, Range range) {
  check::finite({function, "low"}, range.low);
  check::finite({function, "high"}, range.high);
  const double width = range.high - range.low;
  check::positive({function, "high - low"}, width);
  check::at_least({function, "count"}, x.count, 2);
  if (!(x.minimum >= range.low)) check::fail({function, "minimum"}, x.minimum, "inside the range");
  if (!(x.maximum <= range.high)) check::fail({function, "maximum"}, x.maximum, "inside the range");
  // The mean of values at one end of the range may round past it.
  const UnitMean mean{std::clamp(x.mean_less(range.low), 0.0, width) / width,
                      std::clamp(-x.mean_less(range.high), 0.0, width) / width};
  return {static_cast<double>(x.count), mean, x.variance() / width / width};
}

// KL(a || m) of two Bernoulli laws, without the cancellation at a near m.
double bernoulli_divergence(UnitMean a, UnitMean m) {
  if (a.above_low == 0) return -std::log1p(-m.above_low);
  if (a.below_high == 0) return -std::log(m.above_low);
  return -special::log_deviance(a.above_low, m.above_low / a.above_low) -
         special::log_deviance(a.below_high, m.below_high / a.below_high);
}

// The bounds on ln P(mean <= observed | E x >= m), m in (0, 1) and above the observed mean.

double log_mean_bound(const UnitSample& x, UnitMean m) {
  // Any whole number at or above n mean bounds the tail at n mean.
  const auto hits = static_cast<std::uint64_t>(std::min(x.n, std::ceil(x.n * x.mean.above_low)));
  const double bentkus = 1 + binomial_lower(hits, {static_cast<std::uint64_t>(x.n), m.above_low});
  return std::min(-x.n * bernoulli_divergence(x.mean, m), bentkus);
}

// The root L + ln 2 = y^2 of b y^2 + a y - gap = 0.
double log_variance_bound(const UnitSample& x, UnitMean m) {
  const double gap = difference(m, x.mean);
  const double a = std::sqrt(2 * x.variance / x.n);
  const double b = 7 / (3 * (x.n - 1));
  const double y = 2 * gap / (a + std::sqrt(a * a + 4 * b * gap));
  return std::numbers::ln2 - y * y;
}

// The variance's bound covers smaller bets.
constexpr std::array bets{0.875, 0.5, 0.25, 0.125};

// Lower bound on ln of a bet's wealth over n. Here r = (m - mean) / (1 - m) and v = M2 / n / (1 -
// mean)^2.
//   Bound: l r - psi(l) (v (1 + r)^2 + r^2).
// The wealth grows with m, but this bound only up to some r. Beyond, its maximum stands.
double growth(double bet, double r, double v) {
  const double psi = -special::log1p_minus(-bet);
  const double best = std::clamp((bet / (2 * psi) - v) / (1 + v), 0.0, r);
  return bet * best - psi * (v * (1 + best) * (1 + best) + best * best);
}

double log_bets_bound(const UnitSample& x, UnitMean m) {
  const double r = difference(m, x.mean) / m.below_high;
  const double far = x.mean.below_high;
  const double v = x.variance * (1 - 1 / x.n) / far / far;
  std::array<double, bets.size()> logs{};
  for (std::size_t k = 0; k < bets.size(); ++k) logs[k] = x.n * growth(bets[k], r, v);
  return std::log(static_cast<double>(bets.size())) - special::log_sum_of(logs);
}

// ln p of "E x >= m", small when the mean lies below m.
double log_p_below(const UnitSample& x, UnitMean m) {
  if (m.below_high < 0) return special::lowest_log();
  if (m.above_low <= 0) return 0;
  if (m.below_high == 0) return x.mean.below_high > 0 ? special::lowest_log() : 0;
  if (difference(m, x.mean) <= 0) return 0;
  const double smallest =
      std::min({log_mean_bound(x, m), log_variance_bound(x, m), log_bets_bound(x, m)});
  return special::clamp_log(std::log(3.0) + smallest);
}

}  // namespace

TestResult bounded_mean(const Moments& x, Range range, double null_mean) {
  const UnitSample unit = unit_sample("bounded_mean", x, range);
  check::finite({"bounded_mean", "null_mean"}, null_mean);
  const UnitMean null = unit_mean(null_mean, range);
  return {x.mean_less(null_mean),
          {"bound", {}},
          log_p_below(unit, null),
          log_p_below(unit.mirrored(), null.mirrored()),
          Exactness::exact};
}

}  // namespace assay::stats
