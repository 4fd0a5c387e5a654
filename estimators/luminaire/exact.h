#pragma once

// The exact moments of a luminaire scene, without sampling.

#include <functional>
#include <optional>
#include <vector>

#include "luminaire/setting.h"

namespace assay::luminaire {

/// Integrals over the part of a planar luminaire that the receiver sees and that lies above its
/// horizon, for unit radiance.
struct ExactIntegrals {
  double irradiance = 0;      ///< Integral of cos+ over solid angle (Lambert's formula).
  double squared_cosine = 0;  ///< Integral of cos+^2 over solid angle.
  double solid_angle = 0;     ///< Whole luminaire, hidden parts and parts below the horizon.
  double area = 0;            ///< Whole luminaire.
  /// Integral over area of (cos+ light_cosine+ / distance^2)^2, by quadrature to 1e-12. Absent
  /// if that does not converge: the receiver nearly touches the luminaire.
  std::optional<double> squared_geometry;
};

/// A convex polygon that counts once, or once less.
struct SignedPolygon {
  render::Polygon polygon;
  double sign = 1;
};

/// The part of a planar luminaire that the receiver sees above its horizon. It is a sum of signed
/// polygons in the luminaire's plane, in the receiver's frame. It has no polygon if the receiver
/// sees the luminaire's back.
///
/// A convex polygon hides the luminaire clipped to the pyramid from the receiver through the
/// polygon. Several occluders are taken by inclusion and exclusion. The result is nullopt for a
/// mesh and for more than eight occluders. The same holds for an occluder that is no convex
/// polygon, or too near for rays to see.
std::optional<std::vector<SignedPolygon>> visible_parts(const Setting& setting);

/// The integrals of a planar luminaire over its visible_parts(); none where there are none to be
/// had.
std::optional<ExactIntegrals> exact_integrals(const Setting& setting);

/// E[X^2] for unit radiance of the primary X, if it can be had from the exact integrals.
using SecondMoment = std::function<std::optional<double>(const ExactIntegrals&)>;

/// The channel `irradiance` with all that is known exactly: the mean; the variance where
/// subtracting the squared mean leaves ten digits; between 0 and `high`.
Channel irradiance_channel(const Setting& setting, const SecondMoment& second_moment, double high);

/// E = L lambert(polygon) of the whole polygon as it stands, without clipping at the horizon: right
/// only where the luminaire lies above it.
double unclipped_irradiance(const Setting& setting);

}  // namespace assay::luminaire
