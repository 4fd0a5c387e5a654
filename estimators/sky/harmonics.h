#pragma once

// Real spherical harmonics.

#include <array>
#include <cstddef>

#include "render/vector.h"

namespace assay::sky {

inline constexpr std::size_t highest_band = 4;
inline constexpr std::size_t most_harmonics = (highest_band + 1) * (highest_band + 1);

/// Y_00, Y_1-1, Y_10, Y_11, Y_2-2, ...: Y_lm at l (l + 1) + m, up to l = 4.
using Harmonics = std::array<double, most_harmonics>;

/// The orthonormal real harmonics at a unit vector, without the phase (-1)^m: Y_1 is
/// sqrt(3 / 4 pi) (y, z, x), as in Ramamoorthi and Hanrahan (2001), "An efficient representation
/// for irradiance environment maps", equation 3.
Harmonics harmonics(const render::Vector3& w);

/// A_l, the factor of band l in a convolution with the clamped cosine (the same, equation 8). They
/// are pi, 2 pi / 3, pi / 4, 0, -pi / 24; l at most 4.
double cosine_factor(std::size_t band);

}  // namespace assay::sky
