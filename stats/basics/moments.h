#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace assay::stats {

// Thrown where a statistic would divide by a zero variance. A constant sample is an outcome of its
// own, so callers can catch it by name. Every other bad argument is a plain std::domain_error.
class ZeroVariance : public std::domain_error {
 public:
  using std::domain_error::domain_error;
};

// One-pass moments up to order four, with range and count of non-zero values. The members `m2`,
// `m3` and `m4` are sums (not means) of powers of deviations from `mean`. Updating and merging
// formulas: Pebay, SAND2008-6212, equations 1.5 to 1.7 and 2.1 to 2.9. No raw sum of powers is ever
// formed. The mean keeps what rounding takes from it (compensated summation, Kahan 1965). Otherwise
// values near 1e14 with spread 1 would lose every step, and m2 with them. Values must be finite:
// the caller counts the others and keeps them out.
struct Moments {
  std::uint64_t count = 0;
  double mean = 0;
  double m2 = 0;
  double m3 = 0;
  double m4 = 0;
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::uint64_t nonzero = 0;
  double rest = 0;  // The true mean less `mean`, at most half its last digit.

  void add(double value);

  // The mean less this value, including what the mean's own rounding took.
  double mean_less(double value) const { return (mean - value) + rest; }

  // Same as adding the other sample's values here. Merging in a fixed order gives fixed bits.
  void merge(const Moments& other);

  // m2 / (count - 1). This and the next two throw std::domain_error when count < 2. It is inline
  // because maps of images ask for millions.
  double variance() const {
    if (count < 2) refuse_variance();
    return m2 / (static_cast<double>(count) - 1);
  }
  double standard_deviation() const;
  // Standard error of the mean: sqrt(variance / count).
  double standard_error() const;

  // g1 = (m3 / n) / (m2 / n)^1.5 and b2 = (m4 / n) / (m2 / n)^2. A normal law has 0 and 3. They
  // throw std::domain_error when count < 2, ZeroVariance when m2 is zero.
  double skewness() const;
  double kurtosis() const;

  friend bool operator==(const Moments&, const Moments&) = default;

  void refuse_variance() const;  // Throws for fewer than two values.
};

// Moves a mean that keeps in `rest` what rounding takes from it (Kahan 1965).
inline void move_compensated(double step, double& mean, double& rest) {
  const double added = rest + step;
  const double moved = mean + added;
  rest = added - (moved - mean);
  mean = moved;
}

inline void Moments::add(double value) {
  const double before = static_cast<double>(count);
  ++count;
  const double n = before + 1;
  // The reciprocal does not wait for the mean, so the chain from one value to the next has no
  // division.
  const double inverse = 1 / n;
  const double delta = value - mean - rest;
  const double step = delta * inverse;
  const double step2 = step * step;
  const double term = delta * step * before;
  m4 += term * step2 * (n * n - 3 * n + 3) + 6 * step2 * m2 - 4 * step * m3;
  m3 += term * step * (n - 2) - 3 * step * m2;
  m2 += term;
  move_compensated(step, mean, rest);
  minimum = std::min(minimum, value);
  maximum = std::max(maximum, value);
  nonzero += value != 0;
}

// Moments of the finite values of consecutive observations, and which were not finite.
struct FiniteMoments {
  Moments moments = {};
  std::uint64_t nonfinite = 0;
  std::uint64_t first_nonfinite = std::numeric_limits<std::uint64_t>::max();

  void add(double value, std::uint64_t index) {
    if (!(value - value == 0)) {
      if (nonfinite++ == 0) first_nonfinite = index;
    } else {
      moments.add(value);
    }
  }
  // Appends the observations that follow.
  void append(const FiniteMoments& next);
};

// Moments of single values from those of means of n of them: variance times n, skewness times
// sqrt n, excess kurtosis times n. The kurtosis is at least 1 and the square of the skewness, as
// for every law (Pearson 1916).
Moments moments_of_values(Moments means, double n);

// Moments as if `count` means of n values each had been drawn, by the inverse of that. Throws
// ZeroVariance.
Moments moments_of_means(const Moments& values, double n, std::uint64_t count);

// Moments of fewer independent values with the same mean and variance: one in `factor`, at least 4.
Moments moments_of_fewer(Moments x, double factor);

// Standard deviation of what rounding adds to x.mean: ulp / sqrt(12), ulp the spacing of doubles at
// the mean. The values may be added and merged in any order. Moments keeps what each step loses, so
// only the last rounding counts. 0 if the values do not vary.
double rounding_of_mean(const Moments& x);

}  // namespace assay::stats
