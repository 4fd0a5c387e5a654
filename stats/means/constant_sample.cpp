#include "stats/means/constant_sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/basics/search.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "log_p_constant";
constexpr double probability_zero = std::numeric_limits<double>::lowest();

void check_arguments(const ConstantSample& sample, const Reference& reference) {
  check::at_least({function_name, "count"}, sample.count, 1);
  check::finite({function_name, "value"}, sample.value);
  check::finite({function_name, "reference"}, reference.value);
  check::non_negative({function_name, "standard error"}, reference.standard_error);
  if (!(sample.low <= sample.value && sample.value <= sample.high)) {
    check::fail({function_name, "value"}, sample.value, "in the declared range");
  }
}

double reach_toward(const ConstantSample& sample, double other) {
  return other > sample.value ? sample.high - sample.value : sample.value - sample.low;
}

// ln P(no other value in the sample), if these values move its mean by `shift` toward the other.
double log_unseen(const ConstantSample& sample, double other, double shift) {
  const double reach = reach_toward(sample, other);
  if (shift >= reach) return shift > 0 ? probability_zero : 0;
  return static_cast<double>(sample.count) * std::log1p(-shift / reach);
}

}  // namespace

double log_p_constant(const ConstantSample& sample, const Reference& reference) {
  check_arguments(sample, reference);
  const double other = reference.value;
  const double error = reference.standard_error;
  const double size = std::abs(other - sample.value);
  if (size == 0) return 0;
  if (!(error > 0)) return log_unseen(sample, other, size);
  const double least = std::max(0.0, (size - reach_toward(sample, other)) / error);
  // With the reference off by `errors` of its standard errors.
  const auto log_p = [&](double errors) {
    const double shift = std::max(0.0, size - errors * error);
    const double off = std::min(0.0, std::numbers::ln2 + normal_tails(errors).upper);
    return std::max(probability_zero, log_unseen(sample, other, shift) + off);
  };
  return maximum(log_p, least, size / error).value;
}

double log_p_constants(const ConstantSample& a, const ConstantSample& b) {
  check_arguments(a, {b.value});
  check_arguments(b, {a.value});
  const double size = std::abs(b.value - a.value);
  const double least = std::max(0.0, size - reach_toward(b, a.value));
  const double most = std::min(size, reach_toward(a, b.value));
  if (least > most) return probability_zero;
  const auto log_p = [&](double shift) {
    return std::max(probability_zero,
                    log_unseen(a, b.value, shift) + log_unseen(b, a.value, size - shift));
  };
  return maximum(log_p, least, most).value;
}

double size_about(double constant, const Moments& others) {
  check::at_least({"size_about", "count"}, others.count, 1);
  const double n = static_cast<double>(others.count);
  const double d = others.mean_less(constant);
  const double square = others.m2 / n + d * d;
  if (square == 0) return std::numeric_limits<double>::infinity();
  const double fourth =
      others.m4 / n + 4 * d * others.m3 / n + 6 * d * d * others.m2 / n + d * d * d * d;
  return std::sqrt(fourth / square);
}

}  // namespace assay::stats
