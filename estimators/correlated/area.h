#pragma once

// Pairs for the light of an area luminaire: f the irradiance that arrives, g what would arrive if
// nothing stood in the way.

#include "correlated/estimators.h"
#include "luminaire/area.h"

namespace assay::correlated {

/// Points uniform on a planar luminaire: g/p = A L cos+ light_cosine+ / r^2, f = g where nothing
/// hides the point, else 0. J is Lambert's formula for the polygon clipped at the horizon. With
/// polygonal occluders I and the second moments E[f^2] = E[f g] and E[g^2] are exact as well.
class AreaPairs final : public PairSource {
 public:
  /// std::invalid_argument for a luminaire that is not one planar polygon: it may shade itself, and
  /// then J has no closed form.
  AreaPairs(const luminaire::SceneDescription& description, const Location& where);

  const std::vector<Colour>& colours() const override { return colours_; }
  void draw(Stream& random, std::span<Pair> out, Cost& cost) const override;
  std::vector<NamedSampler> samplers() const override {
    return luminaire::point_samplers<>(setting_);
  }

 private:
  luminaire::SharedSetting setting_;
  luminaire::AreaPrimary<> primary_;
  std::vector<Colour> colours_;
};

/// Reads the parameter `scene`; InputError there when the luminaire is a mesh.
std::shared_ptr<const AreaPairs> read_area_pairs(Parameters&);

}  // namespace assay::correlated
