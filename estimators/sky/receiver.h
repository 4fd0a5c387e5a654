#pragma once

// A point with a normal that receives a sky, and the occluders between.

#include <optional>
#include <vector>

#include "estimators/cost.h"
#include "estimators/parameters.h"
#include "render/frame.h"
#include "render/scene.h"

namespace assay::sky {

/// Directions are of the receiver's frame, z along its normal.
class Receiver {
 public:
  /// `normal` is of unit length; `occluders` are in the receiver's frame.
  Receiver(const render::Vector3& normal, const std::vector<render::Shape>& occluders);

  const render::Frame& frame() const { return frame_; }
  bool open() const { return !scene_; }  ///< whether there are no occluders

  /// True if nothing stands in a direction. Counts a shadow ray also under the open sky, which a
  /// renderer cannot know beforehand.
  bool visible(const render::Vector3& w, Cost& cost) const {
    ++cost.shadow_rays;
    return !scene_ || !scene_->occluded({.direction = w});
  }

 private:
  render::Frame frame_;
  std::optional<render::Scene> scene_;
};

/// `sky`, then normal, position, occluders: the parameters of an estimator under a sky.
std::vector<ParameterInformation> with_receiver(ParameterInformation sky);
/// Reads normal, position and occluders. InputError at the offending place.
Receiver read_receiver(Parameters&);

}  // namespace assay::sky
