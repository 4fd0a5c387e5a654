#include "stats/tails/durbin.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

// A square matrix times 2^exponent. Powers leave the range of a double long before the end.
struct ScaledMatrix {
  std::size_t size;
  std::vector<double> entries;
  long exponent = 0;

  double& at(std::size_t row, std::size_t column) { return entries[row * size + column]; }
  double at(std::size_t row, std::size_t column) const { return entries[row * size + column]; }
};

/// Divides by the power of two next to the largest entry; returns its exponent. All entries of a
/// high power are alike in size. In the first powers entries below 2^-500 of the largest become
/// zero. They reach no bit of it, but their denormal products are slow.
int rescale(std::vector<double>& entries) {
  const int shift = std::ilogb(*std::max_element(entries.begin(), entries.end()));
  const double scale = std::ldexp(1.0, -shift);
  for (double& entry : entries) entry = entry * scale < 0x1p-500 ? 0 : entry * scale;
  return shift;
}

// Durbin's matrix and its powers are symmetric about the other diagonal, so half of the entries are
// computed.
ASSAY_VECTOR_COPIES void square(const double* a, std::size_t size, double* c) {
  const std::size_t last = size - 1;
  for (std::size_t i = 0; i < size; ++i) {
    double* const row = c + i * size;
    // Four rows at a time, so that the sum is stored once for the four.
    for (std::size_t k = 0; k < size; k += 4) {
      const std::size_t most = size - 1 - k;
      const auto factor = [&](std::size_t m) { return m <= most ? a[i * size + k + m] : 0; };
      const auto other = [&](std::size_t m) { return a + (k + std::min(m, most)) * size; };
      const double f[] = {factor(0), factor(1), factor(2), factor(3)};
      const double* const o[] = {other(0), other(1), other(2), other(3)};
      for (std::size_t j = 0; j <= last - i; ++j) {
        row[j] = row[j] + f[0] * o[0][j] + f[1] * o[1][j] + f[2] * o[2][j] + f[3] * o[3][j];
      }
    }
    for (std::size_t j = 0; j < last - i; ++j) c[(last - j) * size + last - i] = row[j];
  }
}

ScaledMatrix squared(const ScaledMatrix& a) {
  ScaledMatrix c{a.size, std::vector<double>(a.entries.size(), 0.0), 2 * a.exponent};
  square(a.entries.data(), a.size, c.entries.data());
  c.exponent += rescale(c.entries);
  return c;
}

struct ScaledVector {
  std::vector<double> entries;
  long exponent = 0;
};

void multiply(const ScaledMatrix& matrix, ScaledVector& vector) {
  std::vector<double> product(matrix.size, 0.0);
  for (std::size_t i = 0; i < matrix.size; ++i) {
    for (std::size_t j = 0; j < matrix.size; ++j) {
      product[i] += matrix.at(i, j) * vector.entries[j];
    }
  }
  vector.entries = std::move(product);
  vector.exponent += matrix.exponent + rescale(vector.entries);
}

ScaledVector power_column(ScaledMatrix matrix, std::uint64_t exponent, std::size_t column) {
  ScaledVector result{std::vector<double>(matrix.size, 0.0)};
  result.entries[column] = 1;
  for (; exponent > 0; exponent >>= 1) {
    if ((exponent & 1U) != 0) multiply(matrix, result);
    if (exponent > 1) matrix = squared(matrix);
  }
  return result;
}

// Entries are 1 / (i - j + 1)! below the superdiagonal. The first column and last row are reduced
// by powers of h = k - n d. By this part of a step the boundary misses the lattice.
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
  matrix.exponent = rescale(matrix.entries);
  return matrix;
}

}  // namespace

double log_durbin_lower(double distance, std::uint64_t n) {
  const double size = static_cast<double>(n);
  const double t = size * distance;
  const auto k = static_cast<std::size_t>(t) + 1;
  const double h = static_cast<double>(k) - t;
  const ScaledVector result = power_column(durbin_matrix(2 * k - 1, h), n, k - 1);
  const double entry = result.entries[k - 1];
  return std::log(entry) + static_cast<double>(result.exponent) * std::log(2.0) +
         std::lgamma(size + 1) - size * std::log(size);
}

}  // namespace assay::stats
