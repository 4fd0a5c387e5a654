#include "stats/means/nonnegative_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/basics/check.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

NonnegativeMean::NonnegativeMean(double null_mean) : null_mean_(null_mean) {
  check::finite({"NonnegativeMean", "null_mean"}, null_mean);
}

void NonnegativeMean::add(double value) {
  check::non_negative({"NonnegativeMean::add", "value"}, value);
  count_ += 1;
  mean_ += (value - mean_) / count_;
  if (null_mean_ <= 0) return;
  const double gain = value / null_mean_ - 1;
  double bet = 1;
  for (double& log_wealth : log_wealth_) {
    bet /= 2;
    log_wealth += std::log1p(bet * gain);
  }
}

double NonnegativeMean::log_e() const {
  if (null_mean_ < 0 || (null_mean_ == 0 && mean_ > 0)) return infinity;
  const double largest = *std::max_element(log_wealth_.begin(), log_wealth_.end());
  // value / null_mean overflowed.
  if (largest == infinity) return infinity;
  return special::log_sum_of(log_wealth_) - std::log(static_cast<double>(scales));
}

TestResult NonnegativeMean::result() const {
  if (count_ == 0) check::fail({"NonnegativeMean::result", "count"}, count_, "at least 1");
  return {mean_ - null_mean_, {"bound", {}}, 0, special::clamp_log(-log_e()), Exactness::exact};
}

TestResult nonnegative_mean(std::span<const double> values, double null_mean) {
  NonnegativeMean process(null_mean);
  for (const double value : values) process.add(value);
  return process.result();
}

double nonnegative_mean_lower_limit(std::span<const double> values, double confidence) {
  check::inside_unit({"nonnegative_mean_lower_limit", "confidence"}, confidence);
  const double log_error = std::log1p(-confidence);
  const auto rejected = [&](double m) {
    return nonnegative_mean(values, m).log_p_upper <= log_error;
  };
  if (!rejected(0)) return 0;
  // Every gain is negative once the null mean exceeds the mean enough. At the largest value E < 1.
  double below = 0;
  double above = *std::max_element(values.begin(), values.end());
  while (true) {
    const double middle = below + (above - below) / 2;
    if (middle == below || middle == above) return below;
    (rejected(middle) ? below : above) = middle;
  }
}

}  // namespace assay::stats
