#include "stats/tails/pelz_good.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assay::stats {
namespace {

constexpr double pi2 = std::numbers::pi * std::numbers::pi;
constexpr double pi4 = pi2 * pi2;
constexpr double pi6 = pi4 * pi2;

// The four sums, accumulated over k. Terms are symmetric in k, hence the factors two.
struct Terms {
  double k0 = 0;
  double k1 = 0;
  double k2 = 0;
  double k3 = 0;
};

// Half-integer terms: c = (k + 1/2)^2.
void add_half_integer(Terms& terms, double z2, double k) {
  const double z4 = z2 * z2;
  const double z6 = z4 * z2;
  const double c = (k + 0.5) * (k + 0.5);
  const double weight = 2 * std::exp(-pi2 * c / (2 * z2));
  terms.k0 += weight;
  terms.k1 += weight * (pi2 * c - z2);
  terms.k2 += weight * (6 * z6 + 2 * z4 + pi2 * (2 * z4 - 5 * z2) * c + pi4 * (1 - 2 * z2) * c * c);
  terms.k3 += weight * (pi6 * c * c * c * (5 - 30 * z2) + pi4 * c * c * (-60 * z2 + 212 * z4) +
                        pi2 * c * (135 * z4 - 96 * z6) - 30 * z6 - 90 * z4 * z4);
}

}  // namespace

double pelz_good_lower(double distance, std::uint64_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double z = root * distance;
  const double z2 = z * z;
  const double z3 = z2 * z;
  Terms half;
  double whole2 = 0;
  double whole3 = 0;
  // exp(-pi^2 k^2 / (2 z^2)) < 1e-20 beyond this.
  const double last = std::ceil(z * 3.1) + 1;
  for (double k = 0; k <= last; ++k) {
    add_half_integer(half, z2, k);
    const double c = k * k;
    const double weight = 2 * std::exp(-pi2 * c / (2 * z2));
    whole2 += weight * pi2 * c;
    whole3 += weight * (3 * pi2 * c * z2 - pi4 * c * c);
  }
  const double factor = std::sqrt(std::numbers::pi / 2);
  const double k0 = half.k0 * std::sqrt(2 * std::numbers::pi) / (2 * z);
  const double k1 = factor * half.k1 / (6 * z2 * z2);
  const double k2 = factor * (half.k2 / (72 * z3 * z3 * z) - whole2 / (36 * z3));
  const double k3 = factor * (half.k3 / (6480 * z3 * z3 * z3 * z) + whole3 / (216 * z3 * z3));
  return std::clamp(k0 + (k1 + (k2 + k3 / root) / root) / root, 0.0, 1.0);
}

}  // namespace assay::stats
