#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "render/vector.h"

namespace assay::render {

struct CirclePoint {
  double x;
  double y;
};

/// (cos 2 pi t, sin 2 pi t), each within 2.2e-16, exact at quarter turns; |t| < 2^48. Its bits are
/// the same on every processor. The C library's sincos depends on fused multiplication, and takes
/// three times as long.
///
/// The nearest quarter turn is subtracted exactly, which leaves at most an eighth. Taylor's
/// polynomials end with (pi / 2)^15 / 15! and (pi / 2)^16 / 16! (the next terms are below 5e-17).
/// They are summed in pairs, so that no term waits for all before it.
inline CirclePoint on_unit_circle(double t) {
  constexpr double whole = 0x1.8p52;  // added and taken away it rounds; its last bits are the count
  const double counted = 4 * t + whole;
  const std::uint64_t quarter = std::bit_cast<std::uint64_t>(counted);
  const double r = 4 * t - (counted - whole);
  const double x = r * r;
  const double x2 = x * x;
  const double x4 = x2 * x2;
  const double sine = 1.57079632679489662 * r +
                      r * x *
                          ((-0.645964097506246254 + 0.0796926262461670451 * x) +
                           x2 * (-0.00468175413531868810 + 0.000160441184787359822 * x) +
                           x4 * ((-3.59884323521208534e-06 + 5.69217292196792681e-08 * x) -
                                 x2 * 6.68803510981146723e-10));
  const double cosine =
      1 + x * ((-1.23370055013616983 + 0.253669507901048014 * x) +
               x2 * (-0.0208634807633529609 + 0.000919260274839426580 * x) +
               x4 * ((-2.52020423730606055e-05 + 4.71087477881817150e-07 * x) +
                     x2 * (-6.38660308379185224e-09 + 6.56596311497947236e-11 * x)));
  const bool turned = quarter & 1;
  const auto negated = [](double value, std::uint64_t when) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ (when & 2) << 62);
  };
  return {negated(turned ? sine : cosine, quarter + 1), negated(turned ? cosine : sine, quarter)};
}

/// The unit vector of height z in [0, 1] and azimuth 2 pi v.
inline Vector3 direction_at(double z, double v) {
  const double radius = std::sqrt(1 - z * z);
  const auto [x, y] = on_unit_circle(v);
  return {radius * x, radius * y, z};
}

/// Density 1 / (2 pi) per solid angle: by Archimedes the height is uniform.
struct UniformHemisphere {
  Vector3 operator()(double u, double v) const { return direction_at(u, v); }
  double density(const Vector3&) const { return 1 / (2 * std::numbers::pi); }
};
inline constexpr UniformHemisphere uniform_hemisphere;

/// Density z / pi per solid angle: the projection on the plane z = 0 is uniform in the unit disc.
struct CosineHemisphere {
  Vector3 operator()(double u, double v) const {
    const double radius = std::sqrt(u);
    const auto [x, y] = on_unit_circle(v);
    return {radius * x, radius * y, std::sqrt(1 - u)};
  }
  double density(const Vector3& w) const { return w.z / std::numbers::pi; }
};
inline constexpr CosineHemisphere cosine_hemisphere;

}  // namespace assay::render
