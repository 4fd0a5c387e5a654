#include "stats/means/student_t.h"

#include <cmath>

#include "stats/basics/check.h"
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

void check_samples(const char* function, const Moments& x, const Moments& y) {
  check::at_least({function, "count of x"}, x.count, 2);
  check::at_least({function, "count of y"}, y.count, 2);
  check::finite({function, "mean of x"}, x.mean);
  check::finite({function, "mean of y"}, y.mean);
}

Scale scale_of(const char* function, const Moments& x, const Moments& y, double factor) {
  const double vx = x.variance() / static_cast<double>(x.count);
  const double vy = factor * factor * y.variance() / static_cast<double>(y.count);
  const double total = vx + vy;
  if (total == 0) throw ZeroVariance(std::string(function) + ": zero variance in both samples");
  // Shares of the variance, so that tiny variances do not underflow when squared.
  const double share_x = vx / total;
  const double share_y = vy / total;
  const double degrees = 1 / (share_x * share_x / static_cast<double>(x.count - 1) +
                              share_y * share_y / static_cast<double>(y.count - 1));
  return {std::sqrt(total), degrees};
}

}  // namespace

TestResult student_t(const Moments& x, Reference null_mean, const char* caller) {
  const Scale scale = scale_of(caller, x, null_mean);
  const double t = x.mean_less(null_mean.value) / scale.standard_error;
  return by_tails(t, {"student-t", {scale.degrees}}, student_t_tails(t, scale.degrees));
}

Interval student_t_interval(const Moments& x, Reference reference, double confidence) {
  check::inside_unit({"student_t_interval", "confidence"}, confidence);
  const Scale scale = scale_of("student_t_interval", x, reference);
  const double t = student_t_quantile({Tail::upper, std::log((1 - confidence) / 2)}, scale.degrees);
  const double centre = x.mean_less(reference.value);
  return {centre - t * scale.standard_error, centre + t * scale.standard_error, confidence};
}

double contrast_of_means(const Moments& x, const Moments& y, Contrast contrast) {
  // The rounding errors of the product and of the difference (Dekker 1971, Knuth's two-sum).
  const double product = contrast.scale * y.mean;
  const double of_product = std::fma(contrast.scale, y.mean, -product);
  const double difference = x.mean - product;
  const double back = difference - x.mean;
  const double of_difference = (x.mean - (difference - back)) - (product + back);
  const double rest = x.rest - contrast.scale * y.rest;
  return (difference - contrast.offset) + (of_difference - of_product + rest);
}

TestResult welch_t(const Moments& x, const Moments& y, Contrast null_value, const char* caller) {
  check_samples(caller, x, y);
  check::finite({caller, "scale"}, null_value.scale);
  check::finite({caller, "offset"}, null_value.offset);
  const Scale scale = scale_of(caller, x, y, null_value.scale);
  const double t = contrast_of_means(x, y, null_value) / scale.standard_error;
  return by_tails(t, {"student-t", {scale.degrees}}, student_t_tails(t, scale.degrees));
}

}  // namespace assay::stats
