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
  move_mean(step * b);
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

double rounding_of_mean(const Moments& x) {
  if (!(x.m2 > 0)) return 0;
  const double size = std::abs(x.mean);
  const double spacing = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return spacing / std::sqrt(12.0);
}

}  // namespace assay::stats
