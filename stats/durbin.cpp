#include "stats/durbin.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace assay::stats {
namespace {

// A square matrix times 2^exponent: powers leave the range of a double long before the end.
struct ScaledMatrix {
  std::size_t size;
  std::vector<double> entries;
  long exponent = 0;

  double& at(std::size_t row, std::size_t column) { return entries[row * size + column]; }
  double at(std::size_t row, std::size_t column) const { return entries[row * size + column]; }
};

void rescale(ScaledMatrix& matrix) {
  const double largest = *std::max_element(matrix.entries.begin(), matrix.entries.end());
  const int shift = std::ilogb(largest);
  for (double& entry : matrix.entries) entry = std::ldexp(entry, -shift);
  matrix.exponent += shift;
}

ScaledMatrix product(const ScaledMatrix& a, const ScaledMatrix& b) {
  ScaledMatrix c{a.size, std::vector<double>(a.entries.size(), 0.0), a.exponent + b.exponent};
  for (std::size_t i = 0; i < a.size; ++i) {
    for (std::size_t k = 0; k < a.size; ++k) {
      const double factor = a.at(i, k);
      if (factor == 0) continue;
      for (std::size_t j = 0; j < a.size; ++j) c.at(i, j) += factor * b.at(k, j);
    }
  }
  rescale(c);
  return c;
}

ScaledMatrix power(const ScaledMatrix& base, std::uint64_t exponent) {
  ScaledMatrix result = base;
  for (int bit = static_cast<int>(std::bit_width(exponent)) - 2; bit >= 0; --bit) {
    result = product(result, result);
    if ((exponent >> bit) & 1U) result = product(result, base);
  }
  return result;
}

// 1 / (i - j + 1)! below the superdiagonal, with the first column and last row reduced by powers of
// h = k - n d, the part of a step by which the boundary misses the lattice.
ScaledMatrix durbin_matrix(std::size_t size, double h) {
  ScaledMatrix matrix{size, std::vector<double>(size * size, 0.0), 0};
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= std::min(i + 1, size - 1); ++j) matrix.at(i, j) = 1;
  }
  double power = h;
  for (std::size_t i = 0; i < size; ++i) {
    matrix.at(i, 0) -= power;
    matrix.at(size - 1, size - 1 - i) -= power;
    power *= h;
  }
  const double twice = 2 * h - 1;
  if (twice > 0) matrix.at(size - 1, 0) += std::pow(twice, static_cast<double>(size));
  for (std::size_t i = 0; i < size; ++i) {
    double inverse_factorial = 1;
    for (std::size_t g = 1; g <= i + 1; ++g) {
      inverse_factorial /= static_cast<double>(g);
      if (i + 1 >= g) matrix.at(i, i + 1 - g) *= inverse_factorial;
    }
  }
  return matrix;
}

}  // namespace

double log_durbin_lower(double distance, std::uint64_t n) {
  const double size = static_cast<double>(n);
  const double t = size * distance;
  const auto k = static_cast<std::size_t>(t) + 1;
  const double h = static_cast<double>(k) - t;
  const ScaledMatrix result = power(durbin_matrix(2 * k - 1, h), n);
  const double entry = result.at(k - 1, k - 1);
  return std::log(entry) + static_cast<double>(result.exponent) * std::log(2.0) +
         std::lgamma(size + 1) - size * std::log(size);
}

}  // namespace assay::stats
