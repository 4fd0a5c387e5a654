#include "stats/means/skewness_corrected_t.h"

#include <algorithm>
#include <cmath>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// Hall's transformation with a = skewness of the mean / 6, without a division by a.
double transformed(double t, double a) {
  const double b = a * t;
  return t * (1 + 2 * b + 4 * b * b / 3) + a;
}

struct Law {
  double standard_error = 0;
  double degrees = 0;
  double a = 0;
};

Law law_of(const char* caller, const Moments& x, Reference reference) {
  // Checks its arguments.
  const TestResult plain = student_t(x, reference, caller);
  const double n = static_cast<double>(x.count);
  const double error = reference.standard_error;
  const double influence = x.m2 / n / n + error * error;
  const double share = x.m2 / n / n / influence;
  return {std::hypot(x.standard_error(), error), plain.distribution.parameters[0],
          share * std::sqrt(share) * x.skewness() / (6 * std::sqrt(n))};
}

// One sample's part in the variance of a contrast: factor^2 M2 / n^2.
double influence_variance(const Moments& x, double factor) {
  const double n = static_cast<double>(x.count);
  return factor * factor * (x.m2 / n) / n;
}

double skewness_or_zero(const Moments& x) { return x.m2 > 0 ? x.skewness() : 0; }

Law law_of(const char* caller, const Moments& x, const Moments& y, double scale) {
  // Checks its arguments.
  const TestResult plain = welch_t(x, y, {scale, 0}, caller);
  const double nx = static_cast<double>(x.count);
  const double ny = static_cast<double>(y.count);
  const double of_x = influence_variance(x, 1);
  const double of_y = influence_variance(y, scale);
  const double px = of_x / (of_x + of_y);
  const double py = of_y / (of_x + of_y);
  const double skewness = px * std::sqrt(px / nx) * skewness_or_zero(x) -
                          std::copysign(py * std::sqrt(py / ny), scale) * skewness_or_zero(y);
  const double variance = x.variance() / nx + scale * scale * y.variance() / ny;
  return {std::sqrt(variance), plain.distribution.parameters[0], skewness / 6};
}

TestResult result_of(const char* caller, double difference, const Law& law) {
  const double h = transformed(difference / law.standard_error, law.a);
  check::finite({caller, "transformed statistic"}, h);
  const LogTails tails = student_t_tails(h, law.degrees);
  return {h, {"student-t", {law.degrees}}, tails.lower, tails.upper, Exactness::asymptotic};
}

// ---- The remaining error

struct Residue {
  double a = 0;
  double kurtosis = 0;  // k
  double inverse = 0;   // e
  double square = 0;    // f
};

struct Part {
  double share = 0;
  double count = 1;
  double excess_kurtosis = 0;
};

void add_part(Residue& residue, const Part& part) {
  const double each = part.share * part.share / part.count;
  residue.kurtosis += each * part.excess_kurtosis;
  residue.inverse += each;
  residue.square += each * part.share / part.count;
}

double factor_of(const Residue& r, double x) {
  const double a = std::abs(r.a);
  const double cube = x * x * x;
  const double even = std::max(0.0, x * cube * (r.kurtosis / 4 - 44 * a * a / 3));
  const double odd = a * cube * (16.5 * r.inverse + 121.5 * a * a) * (1 + x * x / 24);
  return std::exp(std::min(even + odd + cube * cube * r.square / 3, 700.0));
}

double excess_or_zero(const Moments& x) { return x.m2 > 0 ? x.kurtosis() - 3 : 0; }

double lower_excess(const Moments& x) {
  return x.m2 > 0 && x.count >= 4 ? kurtosis_gate(x).low : -2;
}

using ExcessKurtosis = double (*)(const Moments&);

Residue residue_of(const char* caller, const Moments& x, Reference reference,
                   ExcessKurtosis excess) {
  const Law law = law_of(caller, x, reference);
  const double of_x = influence_variance(x, 1);
  const double error = reference.standard_error;
  Residue residue{law.a};
  add_part(residue, {of_x / (of_x + error * error), static_cast<double>(x.count), excess(x)});
  return residue;
}

Residue residue_of(const char* caller, const Moments& x, const Moments& y, double scale,
                   ExcessKurtosis excess) {
  const Law law = law_of(caller, x, y, scale);
  const double of_x = influence_variance(x, 1);
  const double of_y = influence_variance(y, scale);
  Residue residue{law.a};
  add_part(residue, {of_x / (of_x + of_y), static_cast<double>(x.count), excess(x)});
  add_part(residue, {of_y / (of_x + of_y), static_cast<double>(y.count), excess(y)});
  return residue;
}

constexpr const char* of_gate = "residual_skewness_gate";

Gate gate_of(const Residue& seen, const Residue& least, double critical_value) {
  check::positive({of_gate, "critical_value"}, critical_value);
  Gate gate{.name = "level factor after correction",
            .value = factor_of(seen, critical_value),
            .low = factor_of(least, critical_value),
            .limit = 2};
  gate.state = state_of(gate, 1.25);
  return gate;
}

}  // namespace

TestResult skewness_corrected_t(const Moments& x, Reference null_mean, const char* caller) {
  return result_of(caller, x.mean_less(null_mean.value), law_of(caller, x, null_mean));
}

TestResult skewness_corrected_welch(const Moments& x, const Moments& y, Contrast null_value,
                                    const char* caller) {
  check::finite({caller, "offset"}, null_value.offset);
  return result_of(caller, contrast_of_means(x, y, null_value),
                   law_of(caller, x, y, null_value.scale));
}

Gate residual_skewness_gate(const Moments& x, Reference null_mean, double critical_value) {
  return gate_of(residue_of(of_gate, x, null_mean, excess_or_zero),
                 residue_of(of_gate, x, null_mean, lower_excess), critical_value);
}

Gate residual_skewness_gate(const Moments& x, const Moments& y, double scale,
                            double critical_value) {
  return gate_of(residue_of(of_gate, x, y, scale, excess_or_zero),
                 residue_of(of_gate, x, y, scale, lower_excess), critical_value);
}

}  // namespace assay::stats
