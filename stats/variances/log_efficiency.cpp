#include "stats/variances/log_efficiency.h"

#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"
#include "stats/gates/normal_test.h"
#include "stats/variances/log_variance.h"

namespace assay::stats {
namespace {

void check_sample(const JointMoments& sample) {
  check::at_least({"log_efficiency_of", "count"}, sample.x.count, 4);
  check::finite({"log_efficiency_of", "sum of fourth powers"}, sample.x.m4);
  check::finite({"log_efficiency_of", "sum of squared deviation times cost"}, sample.m21);
  check::positive({"log_efficiency_of", "mean cost"}, sample.cost.mean);
}

double relative_cost_variance(const JointMoments& sample) {
  return sample.cost.variance() / sample.cost.mean / sample.cost.mean;
}

NormalEstimate one_sample(const char* function, const LogEfficiency& x, double null_efficiency) {
  check::positive({function, "null efficiency"}, null_efficiency);
  return {x.value - std::log(null_efficiency), x.standard_error()};
}

NormalEstimate difference(const LogEfficiency& x, const LogEfficiency& y) {
  return {x.value - y.value, std::sqrt(x.spread / x.count + y.spread / y.count)};
}

}  // namespace

double LogEfficiency::standard_error() const { return std::sqrt(spread / count); }

LogEfficiency log_efficiency_of(const JointMoments& sample) {
  check_sample(sample);
  const double n = static_cast<double>(sample.x.count);
  const double error = log_variance_standard_error(sample.x);
  const double covariance = sample.m21 / sample.x.m2 / sample.cost.mean;
  LogEfficiency result;
  result.value = -std::log(sample.x.variance()) - std::log(sample.cost.mean);
  result.spread = n * error * error + relative_cost_variance(sample) + 2 * covariance;
  result.count = n;
  return result;
}

LogEfficiency log_efficiency_of(const JointMoments& sample, double truth) {
  check_sample(sample);
  check::finite({"log_efficiency_of", "truth"}, truth);
  const Moments& x = sample.x;
  const double n = static_cast<double>(x.count);
  const double bias = x.mean_less(truth);
  const double m2 = x.m2 / n;
  const double mse = m2 + bias * bias;
  if (!(mse > 0)) throw ZeroVariance("log_efficiency_of: the mean squared error is 0");
  // (x - r)^2 = d^2 + 2 bias d + bias^2.
  const double square_variance =
      (x.m4 / n - m2 * m2 + 4 * bias * (x.m3 / n) + 4 * bias * bias * m2) * n / (n - 1);
  const double covariance = (sample.m21 + 2 * bias * sample.m11) / n;
  LogEfficiency result;
  result.value = -std::log(mse) - std::log(sample.cost.mean);
  result.spread = square_variance / mse / mse + relative_cost_variance(sample) +
                  2 * covariance / mse / sample.cost.mean;
  result.count = n;
  if (!(result.standard_error() > 0)) {
    throw ZeroVariance("log_efficiency_of: the mean squared error has no spread");
  }
  return result;
}

TestResult log_efficiency(const LogEfficiency& x, double null_efficiency) {
  return normal_test(one_sample("log_efficiency", x, null_efficiency));
}

Interval log_efficiency_interval(const LogEfficiency& x, double reference_efficiency,
                                 double confidence) {
  check::inside_unit({"log_efficiency_interval", "confidence"}, confidence);
  return normal_interval(one_sample("log_efficiency_interval", x, reference_efficiency),
                         confidence);
}

TestResult log_efficiency_ratio(const LogEfficiency& x, const LogEfficiency& y, double null_ratio) {
  check::positive({"log_efficiency_ratio", "null_ratio"}, null_ratio);
  NormalEstimate estimate = difference(x, y);
  estimate.value -= std::log(null_ratio);
  return normal_test(estimate);
}

Interval log_efficiency_ratio_interval(const LogEfficiency& x, const LogEfficiency& y,
                                       double confidence) {
  check::inside_unit({"log_efficiency_ratio_interval", "confidence"}, confidence);
  return normal_interval(difference(x, y), confidence);
}

}  // namespace assay::stats
