#include "steerable/lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assay::steerable {

namespace {

std::size_t band_of(std::size_t index) {
  std::size_t band = 0;
  while ((band + 1) * (band + 1) <= index) ++band;
  return band;
}

}  // namespace

sky::Harmonics lobe_coefficients(const Lobe& lobe, const render::Vector3& n) {
  sky::Harmonics a = sky::harmonics(n);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = i < lobe.coefficients ? a[i] * sky::cosine_factor(band_of(i)) : 0;
  }
  a[0] += lobe.offset;
  return a;
}

double lobe_value(const Lobe& lobe, double c) {
  constexpr double sphere = 4 * std::numbers::pi;
  double before = 0;
  double legendre = 1;
  double sum = lobe.offset / std::sqrt(sphere);
  for (std::size_t l = 0; l * l < lobe.coefficients; ++l) {
    const auto degree = static_cast<double>(l);
    sum += (2 * degree + 1) / sphere * sky::cosine_factor(l) * legendre;
    const double next = ((2 * degree + 1) * c * legendre - degree * before) / (degree + 1);
    before = legendre;
    legendre = next;
  }
  return sum;
}

double lobe_minimum(const Lobe& lobe) {
  // A polynomial of degree 4 at most: the least of many values is its minimum to 1e-9.
  constexpr int steps = 30000;
  double least = lobe_value(lobe, -1);
  for (int i = 1; i <= steps; ++i) {
    least = std::min(least, lobe_value(lobe, 2.0 * i / steps - 1));
  }
  return least;
}

}  // namespace assay::steerable
