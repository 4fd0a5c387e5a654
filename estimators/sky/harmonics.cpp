#include "sky/harmonics.h"

#include <cmath>
#include <numbers>

namespace assay::sky {

namespace {

using std::numbers::pi;

double factorial(std::size_t n) { return std::tgamma(static_cast<double>(n) + 1); }

// sqrt((2 l + 1) / (4 pi) (l - m)! / (l + m)!), for m > 0 times sqrt(2).
double normalisation(std::size_t l, std::size_t m) {
  const double twice = m == 0 ? 1 : 2;
  return std::sqrt(twice * static_cast<double>(2 * l + 1) / (4 * pi) * factorial(l - m) /
                   factorial(l + m));
}

std::array<double, most_harmonics> normalisations() {
  std::array<double, most_harmonics> table{};
  for (std::size_t l = 0; l <= highest_band; ++l) {
    for (std::size_t m = 0; m <= l; ++m) {
      table[l * (l + 1) + m] = table[l * (l + 1) - m] = normalisation(l, m);
    }
  }
  return table;
}

}  // namespace

Harmonics harmonics(const render::Vector3& w) {
  static const auto scale = normalisations();
  Harmonics y{};
  double cosine = 1;    // sin^m theta cos(m phi)
  double sine = 0;      // sin^m theta sin(m phi)
  double diagonal = 1;  // P_mm / sin^m theta = (2 m - 1)!!
  for (std::size_t m = 0; m <= highest_band; ++m) {
    double before = 0;
    double legendre = diagonal;
    for (std::size_t l = m; l <= highest_band; ++l) {
      const std::size_t middle = l * (l + 1);
      y[middle + m] = scale[middle + m] * legendre * cosine;
      if (m > 0) y[middle - m] = scale[middle - m] * legendre * sine;
      const double next =
          (static_cast<double>(2 * l + 1) * w.z * legendre - static_cast<double>(l + m) * before) /
          static_cast<double>(l + 1 - m);
      before = legendre;
      legendre = next;
    }
    diagonal *= static_cast<double>(2 * m + 1);
    const double turned = cosine * w.x - sine * w.y;
    sine = cosine * w.y + sine * w.x;
    cosine = turned;
  }
  return y;
}

double cosine_factor(std::size_t band) {
  constexpr std::array<double, highest_band + 1> factors = {pi, 2 * pi / 3, pi / 4, 0, -pi / 24};
  return factors.at(band);
}

}  // namespace assay::sky
