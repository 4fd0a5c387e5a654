#pragma once

// Pairs for the light of a sky. f is the irradiance that arrives. g is that of an open uniform sky
// of the same mean.

#include "correlated/estimators.h"
#include "sky/directions.h"

namespace assay::correlated {

/// f/p = L cos+ V / p and g/p = M cos+ / p with M the sky's mean radiance; J = pi M. Directions
/// have a density that is positive wherever cos+ is.
class SkyPairs final : public PairSource {
 public:
  SkyPairs(sky::SharedSetting setting, sky::SharedDirections directions);

  const std::vector<Colour>& colours() const override { return colours_; }
  void draw(Stream& random, std::span<Pair> out, Cost& cost) const override;
  std::vector<NamedSampler> samplers() const override {
    return {{"direction", std::make_shared<sky::DirectionSampler>(setting_, directions_)}};
  }

 private:
  sky::SharedSetting setting_;
  sky::SharedDirections directions_;
  Rgb mean_;
  std::vector<Colour> colours_;
};

/// The parameters of a sky and `sampling`. It is uniform, cosine, emittance (in proportion to the
/// sky, interpolated on 2048 triangles) or steered (the sky times the lobe of nine harmonics).
std::vector<ParameterInformation> sky_pair_parameters();
/// Reads them. InputError at `sky` where emittance or steered sampling would never draw some
/// directions: the sky is black at a vertex.
std::shared_ptr<const SkyPairs> read_sky_pairs(Parameters&);

}  // namespace assay::correlated
