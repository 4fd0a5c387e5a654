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

// The two ways in which a constant and a reference may differ although the claim holds.
struct Difference {
  double size = 0;  // d of the header.
  // Distance from the constant to the end of the range on the reference's side.
  double reach = 0;
  double error = 0;
  double count = 0;

  // ln P(no other value in `count`), if these values move the mean by `shift`.
  double log_unseen(double shift) const {
    if (shift >= reach) return shift > 0 ? probability_zero : 0;
    return count * std::log1p(-shift / reach);
  }
  // ln p with the reference off by `errors` of its standard errors.
  double log_p(double errors) const {
    const double shift = std::max(0.0, size - errors * error);
    const double off = std::min(0.0, std::numbers::ln2 + normal_tails(errors).upper);
    return std::max(probability_zero, log_unseen(shift) + off);
  }
};

double largest_log_p(const Difference& difference) {
  const double least = std::max(0.0, (difference.size - difference.reach) / difference.error);
  const auto log_p = [&](double errors) { return difference.log_p(errors); };
  return maximum(log_p, least, difference.size / difference.error).value;
}

}  // namespace

double log_p_constant(const ConstantSample& sample, const Reference& reference) {
  check_arguments(sample, reference);
  const double size = std::abs(reference.value - sample.value);
  const Difference difference{.size = size,
                              .reach = reach_toward(sample, reference.value),
                              .error = reference.standard_error,
                              .count = static_cast<double>(sample.count)};
  if (size == 0) return 0;
  return difference.error > 0 ? largest_log_p(difference) : difference.log_unseen(size);
}

double log_p_constants(const ConstantSample& a, const ConstantSample& b) {
  check_arguments(a, {b.value});
  check_arguments(b, {a.value});
  const auto at = [](const ConstantSample& sample, double other) {
    return Difference{.reach = reach_toward(sample, other),
                      .count = static_cast<double>(sample.count)};
  };
  const Difference of_a = at(a, b.value);
  const Difference of_b = at(b, a.value);
  const double size = std::abs(b.value - a.value);
  const double least = std::max(0.0, size - of_b.reach);
  const double most = std::min(size, of_a.reach);
  if (least > most) return probability_zero;
  const auto log_p = [&](double shift) {
    return std::max(probability_zero, of_a.log_unseen(shift) + of_b.log_unseen(size - shift));
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
