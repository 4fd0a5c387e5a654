#pragma once

// What a pass of one ray a pixel tells of the noise and the detail that a lens will bring.
//
// A ray through the middle of the lens finds the surface of each pixel, and bisection between
// neighbours of different surfaces finds the edges of occluders. The waves of a surface's texture
// travel to the lens (spectrum.h); their power off the axis of no variation is the variance of the
// radiance over the lens. An edge of an occluder hides a part c = half_plane_coverage(t) of the
// lens (exact.h), t the distance from the pixel to the edge, positive where the occluder covers the
// middle of the lens, over the radius of confusion on the occluder. By the law of total variance
//   V = (1 - c) V_back + c V_front + c (1 - c) (mean_back - mean_front)^2;
// of several edges the one of the largest V counts.
//
// The bandwidth is the highest frequency across the image that the lens lets through, of the waves
// of the pixel's surface and of the edges within reach. A step times a wave is a sum of waves: the
// wave behind travels to the occluder, every frequency k of a step is added and taken away, and all
// travels to the lens. A wave k_front of the step (the image's Nyquist frequency at the most) and
// one k_back behind have across the lens the frequency
//   k_front (1 - d_front / focus) +- k_back (1 - d_back / focus)
// and across the image k_front d_front / focus +- k_back d_back / focus. Of power only whether
// there is any is asked: a step has waves of every length.
//
// No random numbers, and no lens sample that is averaged later: counts that depend on a prediction
// alone leave averages unbiased.

#include <functional>
#include <span>
#include <vector>

#include "depth_of_field/setting.h"
#include "depth_of_field/spectrum.h"

namespace assay::depth_of_field {

/// Pixels of equal squares about the middle of the focal plane, row by row from the lowest y.
struct Grid {
  std::size_t width = 0;
  std::size_t height = 0;
  double size = 0;  ///< of the whole along the width, on the focal plane

  std::size_t pixels() const { return width * height; }
  double pitch() const { return size / static_cast<double>(width); }
  PlanePoint pixel(std::size_t index) const;
};

/// The parts of a prediction.
struct PredictionRules {
  /// The variance that a texture at a depth has over the lens, averaged over its phase.
  std::function<double(const Plane&, const Lens&)> texture_variance;
  /// Whether edges of such an occluder are looked at.
  std::function<bool(const Plane&, const Lens&)> occludes;
  std::function<double(std::span<const CameraFrequency>, const Lens&)> bandwidth;
};

/// By sets of waves, or by covariances (bandwidths are those of waves all the same).
PredictionRules wave_rules();
PredictionRules covariance_rules();

struct Prediction {
  std::vector<double> variance;   ///< of one lens sample, pixel by pixel
  std::vector<double> bandwidth;  ///< highest frequency of the image there, radians per unit length
                                  ///< of the focal plane
  std::vector<bool> background;   ///< whether the pixel's ray hit nothing
  Cost cost;
};

/// Traces the pass. Frequencies of edges are a few an octave, 16 % apart.
Prediction predict(const Setting& setting, const Grid& grid, const PredictionRules& rules);

}  // namespace assay::depth_of_field
