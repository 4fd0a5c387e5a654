#pragma once

// The points of the lens as a sampler that claims can reach.

#include <algorithm>
#include <memory>

#include "depth_of_field/thin_lens.h"
#include "estimators/estimator.h"

namespace assay::depth_of_field {

/// Lens points lifted to the hemisphere above the unit disc, (u, v, sqrt(1 - u^2 - v^2)). Points
/// uniform on the disc become directions of density cos(theta) / pi (Malley's method, backwards).
/// The type `Disc` maps two numbers to a point of the disc.
template <class Disc = UniformDisc>
class LensSampler final : public Sampler {
 public:
  Domain domain() const override { return Domain::hemisphere; }
  SamplerDraw sample(Stream& random) const override {
    const double s = random.uniform();
    const PlanePoint u = Disc{}(s, random.uniform());
    const double height = std::sqrt(std::max(0.0, 1 - u.x * u.x - u.y * u.y));
    SamplerDraw out{.point = {u.x, u.y, height}};
    out.density = density(out.point);
    out.weight = out.density > 0 ? evaluate(out.point) / out.density : 0;
    return out;
  }
  double density(const Point& w) const override { return std::max(0.0, w[2]) / std::numbers::pi; }
  /// The average over the disc: its integral is 1.
  double evaluate(const Point& w) const override { return density(w); }
};

template <class Disc = UniformDisc>
std::vector<NamedSampler> lens_samplers() {
  return {{"lens", std::make_shared<const LensSampler<Disc>>()}};
}

}  // namespace assay::depth_of_field
