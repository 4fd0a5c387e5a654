#include "stats/gates/level_factors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

// Two-sided normal quantile of probability 1e-4.
constexpr double scatter_quantile = 3.9;
// Larger arguments of e^x are left to the library.
constexpr double largest_exponent = 700;

// e^x for |x| <= `largest_exponent`, right to two units in the last place. It has no branches or
// calls, so that many are computed at a time. It is 2^k e^r with |r| <= ln 2 / 2, and e^r by its
// series.
inline double exponential(double x) {
  // Added to a number, leaves it rounded in the last bits.
  constexpr double to_integer = 0x1.8p52;
  constexpr double ln2_high = 0x1.62e42fefa38p-1;
  constexpr double ln2_low = 0x1.ef35793c7673p-45;
  const double shifted = x * 0x1.71547652b82fep0 + to_integer;
  const double k = shifted - to_integer;
  const double r = (x - k * ln2_high) - k * ln2_low;
  constexpr std::array<double, 14> series{1.0 / 6227020800,
                                          1.0 / 479001600,
                                          1.0 / 39916800,
                                          1.0 / 3628800,
                                          1.0 / 362880,
                                          1.0 / 40320,
                                          1.0 / 5040,
                                          1.0 / 720,
                                          1.0 / 120,
                                          1.0 / 24,
                                          1.0 / 6,
                                          1.0 / 2,
                                          1.0,
                                          1.0};
  double sum = series[0];
#pragma GCC unroll 14
  for (std::size_t i = 1; i < series.size(); ++i) sum = sum * r + series[i];
  return sum * std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023) << 52);
}

inline double hyperbolic_cosine(double x) {
  const double e = exponential(std::min(std::abs(x), largest_exponent));
  return (e + 1 / e) / 2;
}

constexpr std::size_t block_size = 256;
using Block = std::array<double, block_size>;

struct Factors {
  Block argument;  // Argument of the hyperbolic cosine.
  Block scatter;   // Its variance.
  Block factor;
  Block excess;
};

ASSAY_VECTOR_COPIES void factors_of(std::span<const Cumulants> cells, double scale, Factors& out) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double variance = cells[i].variance;
    const double unit = scale / (variance * std::sqrt(variance));
    const double scatter = std::min(unit * unit * cells[i].third_variance, 2 * largest_exponent);
    const double centred = exponential(-scatter / 2);
    out.argument[i] = unit * cells[i].third;
    out.scatter[i] = scatter;
    out.factor[i] = hyperbolic_cosine(out.argument[i]) * centred;
    out.excess[i] = hyperbolic_cosine(scatter_quantile * std::sqrt(scatter)) * centred - 1;
  }
}

}  // namespace

void LevelFactors::add(std::span<const Cumulants> cells) {
  Factors factors;
  for (std::size_t done = 0; done < cells.size(); done += block_size) {
    const auto some = cells.subspan(done, std::min(block_size, cells.size() - done));
    factors_of(some, scale_, factors);
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (!(some[i].variance > 0)) continue;
      ++count_;
      const double argument = factors.argument[i];
      sum_ += std::abs(argument) > largest_exponent ? std::cosh(argument) : factors.factor[i];
      excess_ += factors.excess[i];
      arguments_ += argument;
      scatters_ += factors.scatter[i];
      add_to(cells_, some[i]);
    }
  }
}

void LevelFactors::merge(const LevelFactors& other) {
  count_ += other.count_;
  sum_ += other.sum_;
  excess_ += other.excess_;
  arguments_ += other.arguments_;
  scatters_ += other.scatters_;
  add_to(cells_, other.cells_);
}

double LevelFactors::common_skewness(double copies) const {
  const double mean = std::abs(arguments_) - scatter_quantile * std::sqrt(scatters_ * copies);
  const double third =
      std::abs(cells_.third) - scatter_quantile * std::sqrt(cells_.third_variance * copies);
  const double pooled = third / count_ / std::pow(cells_.variance / count_, 1.5);
  return std::max({0.0, mean / count_ / scale_, pooled});
}

double LevelFactors::factor_of(double skewness) const { return std::cosh(scale_ * skewness); }

}  // namespace assay::stats
