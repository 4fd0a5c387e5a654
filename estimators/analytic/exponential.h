#pragma once

// The integrand of the teaching estimators, f(x) = e^(3x) on [0, 1], and what is known of it.

#include <cmath>

namespace assay::analytic {

inline double integrand(double x) { return std::exp(3 * x); }
/// (e^3 - 1) / 3 = 6.361845641
inline double integral() { return std::expm1(3) / 3; }
/// The integral of f^2, (e^6 - 1) / 6.
inline double integral_of_square() { return std::expm1(6) / 6; }

/// A density near f: q(x) = 5 (1 + x)^4 / 31 on [0, 1].
inline double near_density(double x) {
  const double square = (1 + x) * (1 + x);
  return 5 * square * square / 31;
}

}  // namespace assay::analytic
