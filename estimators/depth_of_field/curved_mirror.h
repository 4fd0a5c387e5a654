#pragma once

// A board seen in a mirror that is curved along one axis. The lens is in the plane z = 0. The
// mirror is z = distance + curvature x^2 / 2. The board is at z = distance - beyond. The picture is
// the same for all y.

#include <cmath>

#include "depth_of_field/scene_description.h"

namespace assay::depth_of_field {

struct CurvedMirror {
  double distance = 1;   ///< Distance from the lens to the mirror's vertex, along the axis.
  double beyond = 1;     ///< Distance from there to the board.
  double curvature = 0;  ///< Curvature at the axis, positive if the mirror bulges and scatters.

  /// The place on the board where the ray from x = u of the lens through x = pixel of the focal
  /// plane ends. The ray leaves the mirror with a slope that is `turned` more. First order in
  /// slopes and distances from the axis, as frequencies are carried (spectrum.h).
  double linear(const Lens& lens, double u, double pixel, double turned) const {
    const double slope = (pixel - u) / lens.focus;
    const double x = u + distance * slope;
    return x + beyond * (slope + 2 * curvature * x + turned);
  }

  /// The same by the law of reflection at the parabola. Only where no ray misses it.
  double exact(const Lens& lens, double u, double pixel, double turned) const {
    const double w = pixel - u;
    // The ray from (u, 0) along (w, focus) meets the mirror at t, with
    //  `curvature / 2 (u + w t)^2 - focus t + distance = 0`.
    // The smaller root has no difference of nearly equal numbers here.
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

  /// True if the ray from x = u of the lens to this pixel meets the mirror before the lens and is
  /// sent back. In the quantities of exact(): focus (nx^2 - 1) + 2 w nx < 0.
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

  /// True if the rays from 129 places of the lens return. The condition is smooth in u.
  bool returns_all(const Lens& lens, double pixel) const {
    for (int i = -64; i <= 64; ++i) {
      if (!returns(lens, lens.radius * i / 64, pixel)) return false;
    }
    return true;
  }
};

}  // namespace assay::depth_of_field
