#pragma once

// A point with a normal that receives a sky, and the occluders between.

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "estimators/cost.h"
#include "estimators/estimator.h"
#include "estimators/parameters.h"
#include "render/scene.h"
#include "render/vector.h"
#include "sky/radiance.h"

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

// A receiver under a sky. The estimators of the family estimate the irradiance of each colour,
//   E = integral over directions w of L(w) max(0, n . w) V(w).
// V(w) = 1 if nothing stands in the way, else 0.

/// The parts that do not depend on the sample. Directions are of the receiver's frame, z along its
/// normal.
class Setting : public Receiver {
 public:
  Setting(SharedRadiance radiance, Receiver receiver)
      : Receiver(std::move(receiver)), radiance_(std::move(radiance)) {}

  const Radiance& radiance() const { return *radiance_; }
  std::size_t colours() const { return radiance_->colours(); }

  Rgb radiance(const Vector3& w) const { return (*radiance_)(frame().to_world(w)); }
  /// L cos+ V; below the horizon 0, and no ray is traced.
  Rgb received(const Vector3& w, Cost& cost) const;
  /// The mean of the colours of a value.
  double grey(const Rgb& rgb) const { return radiance_->grey(rgb); }

 private:
  SharedRadiance radiance_;
};

using SharedSetting = std::shared_ptr<const Setting>;

/// sky, normal, position, occluders.
std::vector<ParameterInformation> parameters();
SharedSetting read_setting(Parameters&);

/// `irradiance` of a grey sky; r, g and b of a coloured one. Under the open sky with the mean.
/// Where no primary is above `gain` times the greatest radiance, with that range.
std::vector<Channel> irradiance_channels(const Setting&, std::optional<double> gain = {});

}  // namespace assay::sky
