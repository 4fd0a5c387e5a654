#include "stats/bounded_mean.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stats/check.h"
#include "stats/special.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

// A sample on the unit scale. The upper side is the lower side of 1 - x, so one set of formulas
// serves both.
struct UnitSample {
  double n = 0;
  double mean = 0;
  double variance = 0;

  UnitSample mirrored() const { return {n, 1 - mean, variance}; }
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
  const double mean = std::clamp((x.mean - range.low) / width, 0.0, 1.0);
  return {static_cast<double>(x.count), mean, x.variance() / width / width};
}

// KL(a || m) of two Bernoulli laws, without the cancellation at a near m.
double bernoulli_divergence(double a, double m) {
  if (a == 0) return -std::log1p(-m);
  if (a == 1) return -std::log(m);
  return -special::log_deviance(a, m / a) - special::log_deviance(1 - a, (1 - m) / (1 - a));
}

// ln of the bound on P(mean <= observed | E x >= m), m in (0, 1), from the mean alone.
double log_mean_bound(const UnitSample& x, double m) {
  if (x.mean >= m) return 0;
  // Any whole number at or above n mean bounds the tail at n mean.
  const auto hits = static_cast<std::uint64_t>(std::min(x.n, std::ceil(x.n * x.mean)));
  const double bentkus = 1 + binomial_lower(hits, {static_cast<std::uint64_t>(x.n), m});
  return std::min({0.0, -x.n * bernoulli_divergence(x.mean, m), bentkus});
}

// The same from mean and variance: the root L + ln 2 = y^2 of b y^2 + a y - gap = 0.
double log_variance_bound(const UnitSample& x, double m) {
  const double gap = m - x.mean;
  if (gap <= 0) return 0;
  const double a = std::sqrt(2 * x.variance / x.n);
  const double b = 7 / (3 * (x.n - 1));
  const double y = 2 * gap / (a + std::sqrt(a * a + 4 * b * gap));
  return std::min(0.0, std::numbers::ln2 - y * y);
}

// ln p of "E x >= m", small when the mean lies below m.
double log_p_below(const UnitSample& x, double m) {
  if (m > 1) return special::lowest_log();
  if (m <= 0) return 0;
  if (m == 1) return x.mean < 1 ? special::lowest_log() : 0;
  const double smaller = std::min(log_mean_bound(x, m), log_variance_bound(x, m));
  return special::clamp_log(std::numbers::ln2 + smaller);
}

// The largest m at or above the mean that is not rejected at log_error; p falls with m.
double upper_limit(const UnitSample& x, double log_error) {
  if (log_p_below(x, 1) > log_error) return 1;
  double inside = x.mean;
  double outside = 1;
  while (true) {
    const double middle = inside + (outside - inside) / 2;
    if (middle <= inside || middle >= outside) return outside;
    (log_p_below(x, middle) > log_error ? inside : outside) = middle;
  }
}

}  // namespace

TestResult bounded_mean(const Moments& x, Range range, double null_mean) {
  const UnitSample unit = unit_sample("bounded_mean", x, range);
  check::finite({"bounded_mean", "null_mean"}, null_mean);
  const double width = range.high - range.low;
  return {x.mean - null_mean,
          {"bound", {}},
          log_p_below(unit, (null_mean - range.low) / width),
          log_p_below(unit.mirrored(), (range.high - null_mean) / width),
          Exactness::exact};
}

Interval bounded_mean_interval(const Moments& x, Range range, double confidence) {
  check::inside_unit({"bounded_mean_interval", "confidence"}, confidence);
  const UnitSample unit = unit_sample("bounded_mean_interval", x, range);
  const double width = range.high - range.low;
  const double log_error = std::log((1 - confidence) / 2);
  return {range.high - width * upper_limit(unit.mirrored(), log_error),
          range.low + width * upper_limit(unit, log_error), confidence};
}

}  // namespace assay::stats
