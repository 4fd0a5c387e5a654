#include "stats/basics/moments.h"

#include <cmath>

#include "stats/basics/check.h"

namespace assay::stats {

void Moments::merge(const Moments& other) {
  if (other.count == 0) return;
  if (count == 0) {
    *this = other;
    return;
  }
  const double a = static_cast<double>(count);
  const double b = static_cast<double>(other.count);
  const double n = a + b;
  const double delta = other.mean - mean + (other.rest - rest);
  const double step = delta / n;
  const double step2 = step * step;
  m4 += other.m4 + delta * step * step2 * a * b * (a * a - a * b + b * b) +
        6 * step2 * (a * a * other.m2 + b * b * m2) + 4 * step * (a * other.m3 - b * m3);
  m3 += other.m3 + delta * step2 * a * b * (a - b) + 3 * step * (a * other.m2 - b * m2);
  m2 += other.m2 + delta * step * a * b;
  move_compensated(step * b, mean, rest);
  count += other.count;
  minimum = std::min(minimum, other.minimum);
  maximum = std::max(maximum, other.maximum);
  nonzero += other.nonzero;
}

void Moments::refuse_variance() const { check::at_least({"Moments::variance", "count"}, count, 2); }

double Moments::standard_deviation() const { return std::sqrt(variance()); }

double Moments::standard_error() const {
  return std::sqrt(variance() / static_cast<double>(count));
}

double Moments::skewness() const {
  check::at_least({"Moments::skewness", "count"}, count, 2);
  if (m2 == 0) throw ZeroVariance("Moments::skewness: zero variance");
  return std::sqrt(static_cast<double>(count) / m2) * (m3 / m2);
}

double Moments::kurtosis() const {
  check::at_least({"Moments::kurtosis", "count"}, count, 2);
  if (m2 == 0) throw ZeroVariance("Moments::kurtosis: zero variance");
  return static_cast<double>(count) * (m4 / m2) / m2;
}

void FiniteMoments::append(const FiniteMoments& next) {
  moments.merge(next.moments);
  nonfinite += next.nonfinite;
  first_nonfinite = std::min(first_nonfinite, next.first_nonfinite);
}

Moments moments_of_values(Moments means, double n) {
  if (!(means.m2 > 0)) return means;
  const double least = 1 + n * means.skewness() * means.skewness();
  const double kurtosis = std::max(least, 3 + n * (means.kurtosis() - 3));
  means.m3 *= n * n;
  means.m2 *= n;
  means.m4 = kurtosis * means.m2 * means.m2 / static_cast<double>(means.count);
  return means;
}

Moments moments_of_means(const Moments& values, double n, std::uint64_t count) {
  const double means = static_cast<double>(count);
  Moments moments = values;
  const double kurtosis = 3 + (values.kurtosis() - 3) / n;
  const double skewness = values.skewness() / std::sqrt(n);
  moments.count = count;
  moments.m2 = values.variance() / n * (means - 1);
  moments.m3 = skewness * means * std::pow(moments.m2 / means, 1.5);
  moments.m4 = kurtosis * moments.m2 * moments.m2 / means;
  return moments;
}

Moments moments_of_fewer(Moments x, double factor) {
  const double before = static_cast<double>(x.count);
  const double after = std::max(4.0, std::round(before / factor));
  x.count = static_cast<std::uint64_t>(after);
  x.m2 *= (after - 1) / (before - 1);
  x.m3 *= after / before;
  x.m4 *= after / before;
  return x;
}

double rounding_of_mean(const Moments& x) {
  if (!(x.m2 > 0)) return 0;
  const double size = std::abs(x.mean);
  const double spacing = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return spacing / std::sqrt(12.0);
}

}  // namespace assay::stats
