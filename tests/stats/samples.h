#pragma once

#include "stats/basics/joint_moments.h"
#include "stats/basics/moments.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::tests {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline stats::Moments moments_of(std::span<const double> values) {
  stats::Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

struct Pairs {
  std::vector<double> x;
  std::vector<double> cost;
};

inline stats::JointMoments joint(const Pairs& pairs) {
  stats::JointSums sums;
  for (std::size_t i = 0; i < pairs.x.size(); ++i) sums.add(pairs.x[i], pairs.cost[i]);
  return sums.moments();
}

template <class Draw>
std::vector<double> sample_of(std::size_t n, Draw&& draw) {
  std::vector<double> values(n);
  for (double& value : values) value = draw();
  return values;
}

template <class Draw>
stats::Moments draw_moments(std::size_t n, Draw&& draw) {
  stats::Moments moments;
  for (std::size_t i = 0; i < n; ++i) moments.add(draw());
  return moments;
}

inline stats::Moments normal_moments(Philox& random, std::size_t n, double sd = 1) {
  return draw_moments(n, [&] { return sd * random.normal(); });
}

/// A stationary AR(1) chain of unit variance; of its n values (1 - phi) / (1 + phi) are effective.
inline std::vector<double> autoregressive(double phi, std::size_t n, Philox& random) {
  std::vector<double> values;
  double x = random.normal();
  for (std::size_t t = 0; t < n; ++t) {
    values.push_back(x);
    x = phi * x + std::sqrt(1 - phi * phi) * random.normal();
  }
  return values;
}

// P(K = k), k of n at probability p.
inline double binomial_mass(std::uint64_t k, std::uint64_t n, double p) {
  const double hits = static_cast<double>(k);
  const double misses = static_cast<double>(n - k);
  return std::exp(std::lgamma(hits + misses + 1) - std::lgamma(hits + 1) - std::lgamma(misses + 1) +
                  hits * std::log(p) + misses * std::log1p(-p));
}

/// Counts of n values in cells of these probabilities, cell by cell from the binomial law that the
/// cells before leave.
inline std::vector<std::uint64_t> multinomial(Philox& random, std::uint64_t n,
                                              const std::vector<double>& law) {
  std::vector<std::uint64_t> counts(law.size());
  double left = 1;
  for (std::size_t i = 0; i < law.size() && n > 0; ++i) {
    const double share = std::clamp(law[i] / left, 0.0, 1.0);
    counts[i] =
        i + 1 == law.size() ? n : std::binomial_distribution<std::uint64_t>(n, share)(random);
    n -= counts[i];
    left -= law[i];
  }
  return counts;
}

inline std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

// The data sets of make_tables.py and make_ratios.py.
inline std::vector<double> table_sample(int k, double size) {
  std::vector<double> values;
  for (int i = 1; i <= static_cast<int>(size); ++i) {
    const double tooth = 1 + std::fmod(0.05 * k * i, 3);
    values.push_back(std::cos(i * (0.7 + 0.1 * k)) * tooth + 0.01 * k * i + 0.3 * k);
  }
  return values;
}

// The worked example that golden values of several methods refer to.
inline const std::vector<double> golden_x{.12, .95, .33, 1.71, .58, 2.40, .05, .77, 1.13, .29};
inline const std::vector<double> golden_y{.40, 1.22, .91, 3.10, .66, 1.85, .51};

}  // namespace assay::tests
