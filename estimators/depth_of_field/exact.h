#pragma once

// The average over the lens, without a ray.

#include "depth_of_field/scene_description.h"

namespace assay::depth_of_field {

/// The first two moments of the radiance at a lens point uniform on the disc.
struct Moments {
  double mean = 0;
  double square = 0;
  double error = 0;  ///< estimate of the quadrature's error in either, its last change; 0 of forms
  double variance() const { return square - mean * mean; }
  /// The error of variance() where both moments are off by `error`.
  double variance_error() const { return (1 + 2 * mean) * error; }
};

/// The part of a disc of radius 1 inside a half-plane. The edge has the signed distance d from the
/// centre, positive inside. The part c is 1 - (acos d - d sqrt(1 - d^2)) / pi, 0 below -1 and 1
/// above 1. The variance over the disc of "inside?" is c (1 - c).
double half_plane_coverage(double d);

/// The Fourier transform of the uniform density on the unit disc: j(z) = 2 J1(z) / z, j(0) = 1.
double disc_response(double z);
/// Its first zero, beyond which it is below 0.133 in size.
inline constexpr double first_zero_of_disc_response = 3.8317059702075125;

/// Mean and second moment of `m + a cos(k X + p)` with `X = x + r w`, w uniform on the unit disc.
///  `mean           m + a cos(k x + p) j(k r)
///   second moment  m^2 + 2 m a cos(k x + p) j(k r) + a^2 / 2 (1 + cos(2 (k x + p)) j(2 k r))`
Moments sinusoid_moments(const Texture& texture, const Footprint& seen);

/// The moments of a pixel, in closed form where one surface fills the whole lens. Else they are
/// in closed form along u between the edges, and by quadrature along v (render/quadrature.h). It is
/// refined at most nine times, until it changes by 1e-12 of the value or less; `error` has the last
/// change. An edge before a wave of a thousand radians in the radius of the lens leaves an error of
/// 3e-6.
Moments exact_moments(const SceneDescription& scene, const PlanePoint& pixel);

}  // namespace assay::depth_of_field
