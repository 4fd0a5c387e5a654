#pragma once

#include <cmath>

namespace assay::stats {

// The standard normal z with the tail of Student's t: Phi(z) = F_nu(t). The approximation is Hill's
// (1970, Algorithm 395, Communications of the ACM 13, 617):
//   y = (nu - 1/2) ln(1 + t^2 / nu),  b = 48 (nu - 1/2)^2
//   z = sign(t) sqrt(y) (1 + (y + 3 - (.4 y^3 + 3.3 y^2 + 24 y + 85.5) / (.8 y^2 + 100 + b)) / b)
// For |z| <= 6 the error is at most 5e-4 at nu = 7, 9e-7 at 15 and 2e-8 at 30
// (tests/tables/t_to_z.csv). Use it for maps and for choosing a maximum. A reported p-value comes
// from the exact law. nu must be above 1/2. For an infinite nu z is t.
struct StudentValue {
  double t = 0;
  double degrees = 1;
};
inline double t_to_z(StudentValue value) {
  if (std::isinf(value.degrees)) return value.t;
  const double a = value.degrees - 0.5;
  const double b = 48 * a * a;
  const double y = a * std::log1p(value.t * value.t / value.degrees);
  const double tail = ((0.4 * y + 3.3) * y + 24) * y + 85.5;
  const double size = std::sqrt(y) * (1 + (y + 3 - tail / (0.8 * y * y + 100 + b)) / b);
  return std::copysign(size, value.t);
}

}  // namespace assay::stats
