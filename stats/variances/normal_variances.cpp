#include "stats/variances/normal_variances.h"

#include <cmath>
#include <string>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

void check_sample(const char* function, const Moments& x) {
  check::at_least({function, "count"}, x.count, 2);
  check::finite({function, "sum of squared deviations"}, x.m2);
  if (x.m2 == 0) throw ZeroVariance(std::string(function) + ": zero variance");
}

void check_samples(const char* function, const Moments& x, const Moments& y) {
  check::at_least({function, "count of x"}, x.count, 2);
  check::at_least({function, "count of y"}, y.count, 2);
  check::finite({function, "squared deviations of x"}, x.m2);
  check::finite({function, "squared deviations of y"}, y.m2);
  if (x.m2 == 0 || y.m2 == 0) throw ZeroVariance(std::string(function) + ": zero variance");
}

FDegrees degrees_of(const Moments& x, const Moments& y) {
  return {static_cast<double>(x.count - 1), static_cast<double>(y.count - 1)};
}

}  // namespace

TestResult chi_square_variance(const Moments& x, double null_variance) {
  check_sample("chi_square_variance", x);
  check::positive({"chi_square_variance", "null_variance"}, null_variance);
  const double degrees = static_cast<double>(x.count - 1);
  const double statistic = x.m2 / null_variance;
  return by_tails(statistic, {"chi-square", {degrees}}, chi_square_tails(statistic, degrees));
}

TestResult f_ratio(const Moments& x, const Moments& y, double null_ratio) {
  check_samples("f_ratio", x, y);
  check::positive({"f_ratio", "null_ratio"}, null_ratio);
  const FDegrees degrees = degrees_of(x, y);
  const double f = x.variance() / y.variance() / null_ratio;
  return by_tails(f, {"F", {degrees.numerator, degrees.denominator}}, f_tails(f, degrees));
}

Evidence log_variance_evidence(const Moments& x, const std::optional<Moments>& y, double null) {
  const auto at = [=](double theta) {
    const double value = null * std::exp(theta);
    return y ? f_ratio(x, *y, value) : chi_square_variance(x, value);
  };
  const double estimate = std::log(x.variance() / (y ? y->variance() : 1) / null);
  const double step = std::sqrt(2 / static_cast<double>(x.count - 1) +
                                (y ? 2 / static_cast<double>(y->count - 1) : 0));
  const auto interval = [=](double confidence) {
    return interval_by_inversion(at, {.estimate = estimate, .step = step}, confidence);
  };
  return {.estimate = estimate, .at = at, .interval = interval};
}

}  // namespace assay::stats
