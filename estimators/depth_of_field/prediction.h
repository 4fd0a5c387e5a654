#pragma once

// A pass of one ray a pixel predicts the noise and the detail that a lens will bring.
//
// A ray through the middle of the lens finds the surface of each pixel. Bisection between
// neighbours of different surfaces finds the edges of occluders. The waves of a surface's texture
// travel to the lens (spectrum.h). Their power off the axis of no variation is the variance over
// the lens.
//
// An edge hides a part c = half_plane_coverage(t) of the lens (exact.h). The number t is the
// distance from the pixel to the edge over the radius of confusion on the occluder. It is positive
// if the occluder covers the middle of the lens. The law of total variance gives
//   V = (1 - c) V_back + c V_front + c (1 - c) (mean_back - mean_front)^2.
// The edge of the largest V counts.
//
// The bandwidth is the highest frequency across the image that the lens lets through. The waves are
// those of the pixel's surface and of the edges within reach. The wave behind travels to the
// occluder, and a step adds and subtracts every frequency k. Then all travel to the lens. A wave
// k_front of the step is at most the image's Nyquist frequency; the wave behind is k_back.
//   Across the lens:  k_front (1 - d_front / focus) +- k_back (1 - d_back / focus).
//   Across the image: k_front d_front / focus +- k_back d_back / focus.
// A step has waves of every length, so the only question is if there is power.
//
// No random numbers, and no lens sample that is averaged later: counts that depend on a prediction
// alone leave averages unbiased.

#include <functional>
#include <span>
#include <vector>

#include "depth_of_field/scene_description.h"
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

struct PredictionRules {
  /// The variance that a texture at a depth has over the lens, averaged over its phase.
  std::function<double(const Plane&, const Lens&)> texture_variance;
  /// True if the edges of such an occluder count.
  std::function<bool(const Plane&, const Lens&)> occludes = [](const Plane&, const Lens&) {
    return true;
  };
  std::function<double(std::span<const CameraFrequency>, const Lens&)> bandwidth = image_bandwidth;
};

/// By sets of waves, or by covariances (bandwidths are those of waves all the same).
PredictionRules wave_rules();
PredictionRules covariance_rules();

struct Prediction {
  std::vector<double> variance;   ///< Variance of one lens sample, pixel by pixel.
  std::vector<double> bandwidth;  ///< Highest frequency of the image there, in radians per unit
                                  ///< length of the focal plane.
  std::vector<bool> background;   ///< True if the pixel's ray hit nothing.
  Cost cost;
};

/// Traces the pass. Frequencies of edges are a few an octave, 16 % apart.
Prediction predict(const Setting& setting, const Grid& grid, const PredictionRules& rules);

}  // namespace assay::depth_of_field
