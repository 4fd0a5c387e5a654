#include "stats/means/skewness_corrected_t.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {

double without_skewness(double t, double a) {
  const double b = a * t;
  return t * (1 + 2 * b + 4 * b * b / 3) + a;
}

namespace {

// One of the samples whose means are combined, and the factor of its mean.
struct Part {
  const Moments& x;
  double factor = 1;
  double share = 0;  // Its part of the combination's variance: factor^2 M2 / n^2 over the sum.

  double count() const { return static_cast<double>(x.count); }
};

struct Combination {
  std::vector<Part> parts;
  double standard_error = 0;
  double degrees = 0;
  double a = 0;  // The skewness of the combined mean over 6.
};

// `plain` is the test without the correction, which has checked its arguments.
Combination combination(std::vector<Part> parts, double reference_error, const TestResult& plain) {
  double variance = reference_error * reference_error;
  double sum = variance;
  for (Part& part : parts) {
    variance += part.factor * part.factor * part.x.variance() / part.count();
    part.share = part.factor * part.factor * (part.x.m2 / part.count()) / part.count();
    sum += part.share;
  }
  double skewness = 0;
  for (Part& part : parts) {
    part.share /= sum;
    const double weight = part.share * std::sqrt(part.share / part.count());
    if (part.x.m2 > 0) skewness += std::copysign(weight, part.factor) * part.x.skewness();
  }
  return {std::move(parts), std::sqrt(variance), plain.distribution.parameters[0], skewness / 6};
}

Combination combination(const char* caller, const Moments& x, Reference reference) {
  return combination({{x}}, reference.standard_error, student_t(x, reference, caller));
}

Combination combination(const char* caller, const Moments& x, const Moments& y, double scale) {
  return combination({{x}, {y, -scale}}, 0, welch_t(x, y, {scale, 0}, caller));
}

TestResult result_of(const char* caller, double difference, const Combination& means) {
  const double t = difference / means.standard_error;
  const double h = without_skewness(t, means.a);
  check::finite({caller, "transformed statistic"}, h);
  const LogTails plain = student_t_tails(t, means.degrees);
  const LogTails corrected = student_t_tails(h, means.degrees);
  return by_tails(std::clamp(0.0, std::min(t, h), std::max(t, h)), {"student-t", {means.degrees}},
                  {std::max(plain.lower, corrected.lower), std::max(plain.upper, corrected.upper)});
}

// ---- The remaining error

double excess_or_zero(const Moments& x) { return x.m2 > 0 ? x.kurtosis() - 3 : 0; }

double lower_excess(const Moments& x) {
  return x.m2 > 0 && x.count >= 4 ? kurtosis_gate(x).low : -2;
}

double level_factor(const Combination& means, double x, double (*excess_kurtosis)(const Moments&)) {
  double k = 0, e = 0, f = 0;
  for (const Part& part : means.parts) {
    const double each = part.share * part.share / part.count();
    k += each * excess_kurtosis(part.x);
    e += each;
    f += each * part.share / part.count();
  }
  const double a = std::abs(means.a);
  const double cube = x * x * x;
  const double even = std::max(0.0, x * cube * (k / 4 - 44 * a * a / 3));
  const double odd = a * cube * (16.5 * e + 121.5 * a * a) * (1 + x * x / 24);
  return std::exp(std::min(even + odd + cube * cube * f / 3, 700.0));
}

constexpr const char* of_gate = "residual_skewness_gate";

Gate gate_of(const Combination& means, const Gate& plain, double critical_value) {
  return judged(
      {.name = "level factor after correction",
       .value = std::min(plain.value, level_factor(means, critical_value, excess_or_zero)),
       .low = std::min(plain.low, level_factor(means, critical_value, lower_excess)),
       .limit = 2},
      1.25);
}

}  // namespace

TestResult skewness_corrected_t(const Moments& x, Reference null_mean, const char* caller) {
  return result_of(caller, x.mean_less(null_mean.value), combination(caller, x, null_mean));
}

TestResult skewness_corrected_welch(const Moments& x, const Moments& y, Contrast null_value,
                                    const char* caller) {
  check::finite({caller, "offset"}, null_value.offset);
  return result_of(caller, contrast_of_means(x, y, null_value),
                   combination(caller, x, y, null_value.scale));
}

Gate residual_skewness_gate(const Moments& x, Reference null_mean, double critical_value) {
  const Combination means = combination(of_gate, x, null_mean);
  check::positive({of_gate, "critical_value"}, critical_value);
  // A constant is not skewed.
  const Gate plain = x.m2 > 0 ? skewness_gate(x, critical_value) : Gate{.value = 1, .low = 1};
  return gate_of(means, plain, critical_value);
}

Gate residual_skewness_gate(const Moments& x, const Moments& y, double scale,
                            double critical_value) {
  const Combination means = combination(of_gate, x, y, scale);
  check::positive({of_gate, "critical_value"}, critical_value);
  return gate_of(means, skewness_gate(x, y, scale, critical_value), critical_value);
}

}  // namespace assay::stats
