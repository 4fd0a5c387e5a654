#include "stats/variances/log_variance.h"

#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"
#include "stats/gates/normal_test.h"

namespace assay::stats {
namespace {

double ratio_standard_error(const Moments& x, const Moments& y) {
  return std::hypot(log_variance_standard_error(x), log_variance_standard_error(y));
}

}  // namespace

double log_variance_standard_error(const Moments& x) {
  check::at_least({"log_variance", "count"}, x.count, 4);
  check::finite({"log_variance", "sum of fourth powers"}, x.m4);
  if (x.m2 == 0) throw ZeroVariance("log_variance: zero variance");
  const double n = static_cast<double>(x.count);
  return std::sqrt((x.kurtosis() - (n - 3) / (n - 1)) / n);
}

TestResult log_variance(const Moments& x, double null_variance) {
  check::positive({"log_variance", "null_variance"}, null_variance);
  const double error = log_variance_standard_error(x);
  return normal_test({std::log(x.variance() / null_variance), error});
}

Interval log_variance_interval(const Moments& x, double reference_variance, double confidence) {
  check::positive({"log_variance_interval", "reference_variance"}, reference_variance);
  check::inside_unit({"log_variance_interval", "confidence"}, confidence);
  const double error = log_variance_standard_error(x);
  return normal_interval({std::log(x.variance() / reference_variance), error}, confidence);
}

TestResult log_variance_ratio(const Moments& x, const Moments& y, double null_ratio) {
  check::positive({"log_variance_ratio", "null_ratio"}, null_ratio);
  const double error = ratio_standard_error(x, y);
  return normal_test({std::log(x.variance() / y.variance() / null_ratio), error});
}

Interval log_variance_ratio_interval(const Moments& x, const Moments& y, double confidence) {
  check::inside_unit({"log_variance_ratio_interval", "confidence"}, confidence);
  const double error = ratio_standard_error(x, y);
  return normal_interval({std::log(x.variance() / y.variance()), error}, confidence);
}

}  // namespace assay::stats
