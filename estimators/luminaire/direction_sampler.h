#pragma once

// The sampler of an estimator that picks directions about the receiver's normal.

#include "luminaire/family.h"

namespace assay::luminaire {

inline Point point_of(const render::Vector3& w) { return {w.x, w.y, w.z}; }
inline render::Vector3 direction_of(const Point& p) { return {p[0], p[1], p[2]}; }

/// `Directions` has operator()(u, v) giving a unit vector and density(w) per solid angle.
template <class Directions>
class DirectionSampler final : public Sampler {
 public:
  explicit DirectionSampler(SharedSetting setting) : setting_(std::move(setting)) {}

  Domain domain() const override { return Domain::hemisphere; }

  SamplerDraw sample(Stream& random) const override {
    const double u = random.uniform();
    const double v = random.uniform();
    const Point point = point_of(directions_(u, v));
    const double declared = density(point);
    const double value = evaluate(point);
    return {point, declared, value == 0 ? 0 : value / declared};
  }

  double density(const Point& point) const override {
    return directions_.density(direction_of(point));
  }

  double evaluate(const Point& point) const override {
    Cost uncounted;
    const bool lit = setting_->sees_light(setting_->ray(direction_of(point)), uncounted);
    return lit ? setting_->radiance() * point[2] : 0;
  }

 private:
  SharedSetting setting_;
  Directions directions_;
};

}  // namespace assay::luminaire
