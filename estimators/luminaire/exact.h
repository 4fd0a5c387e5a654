#pragma once

// What is known of a luminaire scene without sampling it.

#include <optional>
#include <vector>

#include "luminaire/setting.h"

namespace assay::luminaire {

/// Integrals over the part of a planar luminaire that the receiver sees and that lies above its
/// horizon, for unit radiance.
struct ExactIntegrals {
  double irradiance = 0;      ///< integral of cos+ over solid angle: Lambert's formula
  double squared_cosine = 0;  ///< integral of cos+^2 over solid angle
  double solid_angle = 0;     ///< of the whole luminaire, hidden and below the horizon included
  double area = 0;            ///< of the whole luminaire
  /// Integral over area of (cos+ light_cosine+ / distance^2)^2, by Gauss-Legendre quadrature to
  /// 1e-12; absent where that does not converge (the receiver nearly touches the luminaire).
  std::optional<double> squared_geometry;
};

/// A convex polygon that counts once, or once less.
struct SignedPolygon {
  render::Polygon polygon;
  double sign = 1;
};

/// The part of a planar luminaire that the receiver sees and that lies above its horizon, as a sum
/// of signed polygons in the luminaire's plane, in the receiver's frame. None for a mesh, for
/// occluders that are more than eight or not convex polygons, or when an occluder is so near to the
/// receiver that rays do not see it. The part of the luminaire behind a convex polygon is the
/// luminaire clipped to the pyramid from the receiver through the polygon; several occluders are
/// taken by inclusion and exclusion. No polygon where the luminaire's back is seen.
std::optional<std::vector<SignedPolygon>> visible_parts(const Setting& setting);

/// The integrals of a planar luminaire over its visible_parts(); none where there are none to be
/// had.
std::optional<ExactIntegrals> exact_integrals(const Setting& setting);

/// E = L lambert(polygon) of the whole polygon as it stands, without clipping at the horizon: right
/// only where the luminaire lies above it.
double unclipped_irradiance(const Setting& setting);

}  // namespace assay::luminaire
