#pragma once

// Ways to draw a direction under a sky.

#include <memory>
#include <numbers>

#include "render/hemisphere.h"
#include "sky/setting.h"

namespace assay::sky {

/// A direction of the receiver's frame, its density per solid angle, and what finding it took.
struct Direction {
  Vector3 w;
  double density = 0;
  int nodes = 0;  ///< of a tree, that were passed through
};

/// Draws directions from two uniform numbers. Immutable, shared by all workers.
class Directions {
 public:
  virtual ~Directions() = default;
  /// hemisphere or sphere.
  virtual Domain domain() const { return Domain::hemisphere; }
  virtual Direction draw(double u, double v) const = 0;
  virtual double density(const Vector3& w) const = 0;
  virtual Panels panels() const { return {}; }
};

using SharedDirections = std::shared_ptr<const Directions>;

/// Density 1 / (2 pi).
class UniformDirections final : public Directions {
 public:
  Direction draw(double u, double v) const override {
    const Vector3 w = render::uniform_hemisphere(u, v);
    return {w, density(w)};
  }
  double density(const Vector3&) const override { return 1 / (2 * std::numbers::pi); }
};

/// Density cos / pi.
class CosineDirections final : public Directions {
 public:
  Direction draw(double u, double v) const override {
    const Vector3 w = render::cosine_hemisphere(u, v);
    return {w, density(w)};
  }
  double density(const Vector3& w) const override { return w.z / std::numbers::pi; }
};

/// Directions as a sampler; evaluate() is L cos+ V, grey.
class DirectionSampler final : public Sampler {
 public:
  DirectionSampler(SharedSetting setting, SharedDirections directions)
      : setting_(std::move(setting)), directions_(std::move(directions)) {}

  Domain domain() const override { return directions_->domain(); }
  SamplerDraw sample(Stream& random) const override {
    const double u = random.uniform();
    const Direction d = directions_->draw(u, random.uniform());
    const Point point = {d.w.x, d.w.y, d.w.z};
    const double value = evaluate(point);
    return {.point = point, .density = d.density, .weight = value == 0 ? 0 : value / d.density};
  }
  double density(const Point& p) const override { return directions_->density({p[0], p[1], p[2]}); }
  double evaluate(const Point& p) const override {
    Cost uncounted;
    return setting_->grey(setting_->received({p[0], p[1], p[2]}, uncounted));
  }
  Panels panels() const override { return directions_->panels(); }

 private:
  SharedSetting setting_;
  SharedDirections directions_;
};

}  // namespace assay::sky
