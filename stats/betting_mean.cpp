#include "stats/betting_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/check.h"
#include "stats/special.h"

namespace assay::stats {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double width_of(Range range) { return range.high - range.low; }

void check_betting(const char* function, const Betting& betting) {
  check::finite({function, "low"}, betting.range.low);
  check::finite({function, "high"}, betting.range.high);
  check::positive({function, "high - low"}, width_of(betting.range));
  check::inside_unit({function, "error"}, betting.error);
}

// ln of one round's return on "the mean exceeds m". At an impossible m <= 0 any value above m is
// proof; the bet on the other side is the same with x and m mirrored.
double log_return(double x, double bet, double m) {
  if (m <= 0) return x > m ? infinity : 0;
  return std::log1p(std::min(bet, 0.5 / m) * (x - m));
}

// A wager that won everything stays won.
void add_to(double& log_wealth, double log_gain) {
  log_wealth = log_wealth == infinity ? infinity : log_wealth + log_gain;
}

// The largest null mean for which `survives` holds; it holds at `inside` and fails beyond the end.
template <class Survives>
double last_surviving(double inside, double outside, const Survives& survives) {
  while (true) {
    const double middle = inside + (outside - inside) / 2;
    if (middle == inside || middle == outside) return outside;
    (survives(middle) ? inside : outside) = middle;
  }
}

}  // namespace

BettingMean::BettingMean(Betting betting, double null_mean)
    : betting_(betting), null_mean_(null_mean) {
  check_betting("BettingMean", betting);
  check::finite({"BettingMean", "null_mean"}, null_mean);
  unit_null_ = (null_mean - betting.range.low) / width_of(betting.range);
}

double BettingMean::next_bet() const {
  const double variance = (0.25 + squares_) / (count_ + 1);
  const double i = count_ + 1;
  return std::sqrt(2 * std::log(2 / betting_.error) / (i * std::log1p(i) * variance));
}

void BettingMean::add(double value) {
  const Range range = betting_.range;
  if (!(value >= range.low && value <= range.high)) {
    check::fail({"BettingMean::add", "value"}, value, "inside the range");
  }
  const double x = (value - range.low) / width_of(range);
  const double bet = next_bet();
  add_to(log_above_, log_return(x, bet, unit_null_));
  add_to(log_below_, log_return(1 - x, bet, 1 - unit_null_));
  count_ += 1;
  sum_ += x;
  const double deviation = x - (0.5 + sum_) / (count_ + 1);
  squares_ += deviation * deviation;
}

double BettingMean::log_e_above() const { return log_above_; }
double BettingMean::log_e_below() const { return log_below_; }

TestResult BettingMean::result() const {
  if (count_ == 0) check::fail({"BettingMean::result", "count"}, count_, "at least 1");
  const double mean = betting_.range.low + width_of(betting_.range) * (sum_ / count_);
  return {mean - null_mean_,
          {"bound", {}},
          special::clamp_log(-log_below_),
          special::clamp_log(-log_above_),
          Exactness::exact};
}

TestResult betting_mean(std::span<const double> values, Betting betting, double null_mean) {
  BettingMean process(betting, null_mean);
  for (const double value : values) process.add(value);
  return process.result();
}

Interval betting_mean_interval(std::span<const double> values, Betting betting, double confidence) {
  check::inside_unit({"betting_mean_interval", "confidence"}, confidence);
  const double log_error = std::log((1 - confidence) / 2);
  const auto tails = [&](double m) { return betting_mean(values, betting, m); };
  // At the low end of the range nothing below can be rejected, and likewise above.
  const double mean = betting.range.low + tails(betting.range.low).statistic;
  const auto not_too_high = [&](double m) { return tails(m).log_p_lower > log_error; };
  const auto not_too_low = [&](double m) { return tails(m).log_p_upper > log_error; };
  const auto [low, high] = betting.range;
  // The wagers at the mean itself are seldom won, but they may be: then the interval starts there.
  Interval interval{low, high, confidence};
  if (!not_too_high(high)) {
    interval.high = last_surviving(not_too_high(mean) ? mean : low, high, not_too_high);
  }
  if (!not_too_low(low)) {
    interval.low = last_surviving(not_too_low(mean) ? mean : high, low, not_too_low);
  }
  return interval;
}

}  // namespace assay::stats
