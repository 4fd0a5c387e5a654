#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace assay::stats {

// One-pass moments up to order four, with range and count of non-zero values. `m2`, `m3` and `m4`
// are sums (not means) of powers of deviations from `mean`. Updating and merging formulas: Pebay,
// SAND2008-6212, equations 1.5 to 1.7 and 2.1 to 2.9; no raw sum of powers is ever formed.
// What rounding takes from the mean is kept beside it (compensated summation, Kahan 1965): of
// values of 1e14 that spread over 1 every step would be lost, and with the mean m2. Values must be
// finite: the caller counts the others and keeps them out.
struct Moments {
  std::uint64_t count = 0;
  double mean = 0;
  double m2 = 0;
  double m3 = 0;
  double m4 = 0;
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::uint64_t nonzero = 0;
  double rest = 0;  // by which the mean is more than `mean`, half its last digit at most

  void add(double value);

  // The mean less this value, with what the mean's own rounding took.
  double mean_less(double value) const { return (mean - value) + rest; }

  // As if the other sample's values had been added here. Merging in a fixed order gives fixed bits.
  void merge(const Moments& other);

  // m2 / (count - 1). Throws std::domain_error when count < 2, as do the next two. Here, since maps
  // of images ask for millions.
  double variance() const {
    if (count < 2) refuse_variance();
    return m2 / (static_cast<double>(count) - 1);
  }
  double standard_deviation() const;
  // Of the mean: sqrt(variance / count).
  double standard_error() const;

  // g1 = (m3 / n) / (m2 / n)^1.5 and b2 = (m4 / n) / (m2 / n)^2; a normal law has 0 and 3.
  // Throw std::domain_error when count < 2, ZeroVariance when m2 is zero.
  double skewness() const;
  double kurtosis() const;

  friend bool operator==(const Moments&, const Moments&) = default;

  void refuse_variance() const;  // of fewer than two values
  void move_mean(double step);
};

inline void Moments::move_mean(double step) {
  const double added = rest + step;
  const double moved = mean + added;
  rest = added - (moved - mean);
  mean = moved;
}

inline void Moments::add(double value) {
  const double before = static_cast<double>(count);
  ++count;
  const double n = before + 1;
  // The reciprocal does not wait for the mean: the chain from one value to the next has no
  // division.
  const double inverse = 1 / n;
  const double delta = value - mean - rest;
  const double step = delta * inverse;
  const double step2 = step * step;
  const double term = delta * step * before;
  m4 += term * step2 * (n * n - 3 * n + 3) + 6 * step2 * m2 - 4 * step * m3;
  m3 += term * step * (n - 2) - 3 * step * m2;
  m2 += term;
  move_mean(step);
  minimum = std::min(minimum, value);
  maximum = std::max(maximum, value);
  nonzero += value != 0;
}

}  // namespace assay::stats
