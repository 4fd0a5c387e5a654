#pragma once

// The clamped cosine by a few spherical harmonics, which can be steered: turned to any normal by
// changing their coefficients alone.

#include <cstddef>

#include "sky/harmonics.h"

namespace assay::steerable {

/// The first terms of cos+ = sum A_l Y_lm(n) Y_lm(w), with `offset` added to the coefficient of
/// Y_00. The number `coefficients` is 1, 4, 9 or 25: bands 0 to 0, 1, 2 or 4. Band 3 of the clamped
/// cosine is zero.
struct Lobe {
  std::size_t coefficients = 9;
  double offset = 0.15;
};

/// a such that the lobe about n is sum a_i Y_i(w); zero from `coefficients` on.
sky::Harmonics lobe_coefficients(const Lobe& lobe, const render::Vector3& n);

/// The lobe's value at the cosine c to its normal. By Legendre polynomials it is sum (2 l + 1) / (4
/// pi) A_l P_l(c) + offset / sqrt(4 pi).
double lobe_value(const Lobe& lobe, double c);

/// The least value of the lobe. With nine coefficients and no offset -19/480, at c = -8/15.
double lobe_minimum(const Lobe& lobe);

}  // namespace assay::steerable
