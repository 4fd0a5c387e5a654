#pragma once

// A board seen in a mirror that bulges or is hollow, along one axis: a lens in the plane z = 0, the
// mirror z = distance + curvature x^2 / 2 before it, and the board at z = distance - beyond. What
// the lens does not see of the other axis does not change: the picture is the same for all y.

#include <cmath>

#include "depth_of_field/thin_lens.h"

namespace assay::depth_of_field {

struct CurvedMirror {
  double distance = 1;   ///< from the lens to the mirror's vertex, along the axis
  double beyond = 1;     ///< from there to the board
  double curvature = 0;  ///< where it meets the axis; positive where it bulges and scatters light

  /// Where on the board the ray from x = u of the lens through x = pixel of the focal plane ends if
  /// the slope that it leaves the mirror with is `turned` more: to first order in slopes and
  /// distances from the axis, as frequencies are carried (spectrum.h).
  double linear(const Lens& lens, double u, double pixel, double turned) const {
    const double slope = (pixel - u) / lens.focus;
    const double x = u + distance * slope;
    return x + beyond * (slope + 2 * curvature * x + turned);
  }

  /// The same by the law of reflection at the parabola. Only where no ray misses it.
  double exact(const Lens& lens, double u, double pixel, double turned) const {
    const double w = pixel - u;
    // At t along (w, focus) from (u, 0): curvature / 2 (u + w t)^2 - focus t + distance = 0, the
    // smaller root without a difference of nearly equal numbers.
    const double a = curvature * w * w / 2;
    const double b = lens.focus - curvature * u * w;
    const double c = distance + curvature * u * u / 2;
    const double t = 2 * c / (b + std::sqrt(b * b - 4 * a * c));
    const double x = u + w * t;
    // About the normal (curvature x, -1) the ray (w, focus) becomes (w, focus) - 2 (d.n) / (n.n) n.
    const double nx = curvature * x;
    const double share = 2 * (w * nx - lens.focus) / (nx * nx + 1);
    const double slope = (w - share * nx) / -(lens.focus + share);
    return x + (beyond + curvature * x * x / 2) * (slope + turned);
  }

  /// Whether the ray from x = u of the lens to this pixel meets the mirror, in front of the lens,
  /// and is sent back: of the quantities in exact(), focus (nx^2 - 1) + 2 w nx < 0.
  bool returns(const Lens& lens, double u, double pixel) const {
    const double w = pixel - u;
    const double a = curvature * w * w / 2;
    const double b = lens.focus - curvature * u * w;
    const double c = distance + curvature * u * u / 2;
    const double discriminant = b * b - 4 * a * c;
    if (c <= 0 || discriminant < 0 || b + std::sqrt(discriminant) <= 0) return false;
    const double nx = curvature * (u + w * 2 * c / (b + std::sqrt(discriminant)));
    return lens.focus * (nx * nx - 1) + 2 * w * nx < 0;
  }

  /// Whether all do that start at 129 places of the lens; what they depend on is smooth in u.
  bool returns_all(const Lens& lens, double pixel) const {
    for (int i = -64; i <= 64; ++i) {
      if (!returns(lens, lens.radius * i / 64, pixel)) return false;
    }
    return true;
  }
};

}  // namespace assay::depth_of_field
