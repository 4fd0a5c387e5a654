#pragma once

// How a surface scatters light: rough, like a mirror, or like glass.
//
// Directions are in the frame of the surface, whose normal is +z, and point away from it. `in` is
// where the path comes from. A path is traced from the camera, so `out` is where light comes from.

#include <algorithm>
#include <cmath>
#include <variant>

#include "estimators/stream.h"
#include "paths/spectrum.h"
#include "render/frame.h"
#include "render/hemisphere.h"

namespace assay::path_tracing {

using paths::Spectrum;
using render::Vector3;

/// The next direction of a path. Its weight is BSDF x cosine / density. A mirror's or glass's
/// direction is no choice among others: its density is zero, and no light can be sampled for it.
struct Scattered {
  Vector3 out;
  Spectrum weight;
  double density = 0;
  bool survives = true;
};

/// A diffuse base and a lobe of Phong's about the mirror direction (Lafortune and Willems 1994):
///   f = diffuse / pi + glossy (n + 2) / (2 pi) max(0, cos a)^n,
/// a the angle to the mirror direction. It is reciprocal. It conserves energy if diffuse + glossy
/// <= 1. Directions have the density
///   p = (1 - q) cos / pi + q (n + 1) / (2 pi) cos^n a, with q = glossy / (diffuse + glossy)
/// by their greatest components. What the lobe sends below the surface is lost: its weight is 0.
struct Rough {
  Spectrum diffuse;
  Spectrum glossy = {};
  double exponent = 1;

  Spectrum value(const Vector3& in, const Vector3& out) const;
  double density(const Vector3& in, const Vector3& out) const;
  Scattered scatter(const Vector3& in, Stream& random) const;

 private:
  double lobe_share() const;
  double lobe(const Vector3& in, const Vector3& out) const;
};

struct Mirror {
  Spectrum reflectance;
};

/// A smooth boundary; the outside, where z > 0, has index 1. Radiance is not scaled by the index:
/// the factors of entering and leaving cancel, and no camera and no light is inside.
struct Glass {
  double index = 1.5;
};

/// Takes in all light.
struct Black {};

using Material = std::variant<Black, Rough, Mirror, Glass>;

/// The reflectance of a smooth boundary for light that is not polarised (Fresnel). `cosine` is that
/// of the incident side, `ratio` the index of the other side over that of the incident side. 1 from
/// the critical angle on.
double fresnel(double cosine, double ratio);

/// Reflects with the probability of the `reflectance` of the boundary, or else refracts by Snell.
/// Both weights are 1.
Scattered scatter(const Glass& glass, const Vector3& in, double (*reflectance)(double, double),
                  Stream& random);

}  // namespace assay::path_tracing
