#pragma once

// A receiver under a sky. The estimators of the family estimate the irradiance of each colour,
//   E = integral over directions w of L(w) max(0, n . w) V(w),
// V(w) = 1 where nothing stands in the way, else 0.

#include <memory>
#include <optional>
#include <vector>

#include "estimators/estimator.h"
#include "render/frame.h"
#include "render/scene.h"
#include "sky/radiance.h"

namespace assay::sky {

/// What does not depend on the sample. Directions are of the receiver's frame, z along its normal.
class Setting {
 public:
  /// `normal` is of unit length; `occluders` are in the receiver's frame.
  Setting(SharedRadiance radiance, const Vector3& normal,
          const std::vector<render::Shape>& occluders);

  const Radiance& radiance() const { return *radiance_; }
  const render::Frame& frame() const { return frame_; }
  bool open() const { return !scene_; }  ///< whether there are no occluders
  std::size_t colours() const { return radiance_->colours(); }

  /// Whether nothing stands in a direction. Counts a shadow ray also under the open sky, which a
  /// renderer cannot know beforehand.
  bool visible(const Vector3& w, Cost& cost) const {
    ++cost.shadow_rays;
    return !scene_ || !scene_->occluded({.origin = {}, .direction = w});
  }
  Rgb radiance(const Vector3& w) const { return (*radiance_)(frame_.to_world(w)); }
  /// L cos+ V; below the horizon 0, and no ray is traced.
  Rgb received(const Vector3& w, Cost& cost) const;
  /// The mean of the colours of a value.
  double grey(const Rgb& rgb) const {
    return colours() == 1 ? rgb[0] : (rgb[0] + rgb[1] + rgb[2]) / 3;
  }

 private:
  SharedRadiance radiance_;
  render::Frame frame_;
  std::optional<render::Scene> scene_;
};

using SharedSetting = std::shared_ptr<const Setting>;

/// sky, normal, position, occluders.
std::vector<ParameterInformation> parameters();
/// Reads them.
SharedSetting read_setting(Parameters&);

/// `irradiance` of a grey sky; r, g and b of a coloured one. Under the open sky with the mean.
std::vector<Channel> irradiance_channels(const Setting&);

}  // namespace assay::sky
