#pragma once

// A receiver under the picture of an environment, with occluders between. The estimators of the
// family estimate the irradiance of each colour channel,
//   E = integral over directions w of L(w) max(0, n . w) V(w).
// V(w) = 1 if nothing stands in the way, else 0.

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "estimators/estimator.h"
#include "render/environment_map.h"
#include "render/patch_integrals.h"
#include "sky/receiver.h"

namespace assay::environment {

using render::Rgb;

class Sky : public sky::Receiver {
 public:
  Sky(render::EnvironmentMap map, sky::Receiver receiver)
      : sky::Receiver(std::move(receiver)), map_(std::move(map)) {}

  const render::EnvironmentMap& map() const { return map_; }

 private:
  render::EnvironmentMap map_;
};

using SharedSky = std::shared_ptr<const Sky>;

/// map, normal, position, occluders.
std::vector<ParameterInformation> parameters();
/// Reads them. InputError at the parameter for a picture that cannot be used.
SharedSky read_sky(Parameters&);

struct Primaries {
  /// E[X^2] of a channel is the sum of L^2 times this over texels of radiance L.
  std::function<double(std::size_t texel, const render::CosineMoments&)> second_moment;
  Rgb largest;  ///< no X is above, channel by channel
};

/// The channels r, g, b. Under the open sky with mean (exact to `mean_error`) and variance.
std::vector<Channel> irradiance_channels(const Sky& sky, const Primaries& primaries);

/// Mean of the three channels: what samplers of directions evaluate.
inline double grey(const Rgb& rgb) { return (rgb[0] + rgb[1] + rgb[2]) / 3; }

/// An estimator whose primary, Rgb(Stream&, Cost&), has three channels.
template <class Primary>
class RgbEstimator final : public Estimator {
 public:
  explicit RgbEstimator(Primary primary) : primary_(std::move(primary)) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    Rgb sum{};
    for (std::uint64_t i = 0; i < primaries; ++i) {
      const Rgb value = primary_(random, cost);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += value[c];
    }
    for (std::size_t c = 0; c < 3; ++c) out[c] = sum[c] / static_cast<double>(primaries);
    cost.samples += primaries;
  }

 private:
  Primary primary_;
};

template <class Primary>
std::shared_ptr<const Setup> rgb_setup(std::vector<Channel> channels, Primary primary,
                                       NamedSampler sampler) {
  return setup_of({.channels = std::move(channels),
                   .make = [primary] { return std::make_unique<RgbEstimator<Primary>>(primary); },
                   .samplers = {std::move(sampler)}});
}

}  // namespace assay::environment
