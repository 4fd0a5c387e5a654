#include "stats/means/student_t.h"

#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

struct Scale {
  double standard_error;
  double degrees;
};

Scale scale_of(const char* function, const Moments& x, Reference reference) {
  check::at_least({function, "count"}, x.count, 2);
  check::finite({function, "mean"}, x.mean);
  check::finite({function, "reference value"}, reference.value);
  check::non_negative({function, "reference standard error"}, reference.standard_error);
  if (x.m2 == 0) throw ZeroVariance(std::string(function) + ": zero variance");
  const double n = static_cast<double>(x.count);
  const double own = x.variance() / n;
  const double total = own + reference.standard_error * reference.standard_error;
  const double inflation = total / own;
  return {std::sqrt(total), (n - 1) * inflation * inflation};
}

}  // namespace

TestResult student_t(const Moments& x, Reference null_mean, const char* caller) {
  const Scale scale = scale_of(caller, x, null_mean);
  const double t = x.mean_less(null_mean.value) / scale.standard_error;
  const LogTails tails = student_t_tails(t, scale.degrees);
  return {t,
          {"student-t", {scale.degrees}},
          tails.lower,
          tails.upper,
          null_mean.standard_error > 0 ? Exactness::asymptotic : Exactness::exact};
}

Interval student_t_interval(const Moments& x, Reference reference, double confidence) {
  check::inside_unit({"student_t_interval", "confidence"}, confidence);
  const Scale scale = scale_of("student_t_interval", x, reference);
  const double t = student_t_quantile({Tail::upper, std::log((1 - confidence) / 2)}, scale.degrees);
  const double centre = x.mean_less(reference.value);
  return {centre - t * scale.standard_error, centre + t * scale.standard_error, confidence};
}

}  // namespace assay::stats
