#pragma once

#include "render/environment_map.h"

namespace assay::render {

/// Integrals of max(0, n . w)^k over a patch, k = 1 and 2.
struct CosineMoments {
  double first = 0;
  double second = 0;
  double error = 0;  ///< bound of the error of either
};

/// The moments in closed form if the patch is wholly above or below the horizon of the unit vector
/// `normal`. If the horizon may cross it, they have a closed form along each meridian. Quadrature
/// over the azimuth runs between the points where the horizon enters and leaves.
CosineMoments cosine_moments(const Patch&, const Vector3& normal);

}  // namespace assay::render
