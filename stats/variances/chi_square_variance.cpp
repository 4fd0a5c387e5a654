#include "stats/variances/chi_square_variance.h"

#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

void check_sample(const char* function, const Moments& x) {
  check::at_least({function, "count"}, x.count, 2);
  check::finite({function, "sum of squared deviations"}, x.m2);
  if (x.m2 == 0) throw ZeroVariance(std::string(function) + ": zero variance");
}

}  // namespace

TestResult chi_square_variance(const Moments& x, double null_variance) {
  check_sample("chi_square_variance", x);
  check::positive({"chi_square_variance", "null_variance"}, null_variance);
  const double degrees = static_cast<double>(x.count - 1);
  const double statistic = x.m2 / null_variance;
  const LogTails tails = chi_square_tails(statistic, degrees);
  return {statistic, {"chi-square", {degrees}}, tails.lower, tails.upper, Exactness::exact};
}

Interval chi_square_variance_interval(const Moments& x, double confidence) {
  check_sample("chi_square_variance_interval", x);
  check::inside_unit({"chi_square_variance_interval", "confidence"}, confidence);
  const double degrees = static_cast<double>(x.count - 1);
  const double log_tail = std::log((1 - confidence) / 2);
  return {x.m2 / chi_square_quantile({Tail::upper, log_tail}, degrees),
          x.m2 / chi_square_quantile({Tail::lower, log_tail}, degrees), confidence};
}

}  // namespace assay::stats
