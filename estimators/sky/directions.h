#pragma once

// Ways to draw a direction under a sky.

#include <memory>
#include <utility>
#include <vector>

#include "estimators/parameters.h"
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

/// Directions of the receiver's hemisphere, of render/hemisphere.h.
template <class Hemisphere>
class HemisphereDirections final : public Directions {
 public:
  Direction draw(double u, double v) const override {
    const Vector3 w = Hemisphere{}(u, v);
    return {w, density(w)};
  }
  double density(const Vector3& w) const override { return Hemisphere{}.density(w); }
};

using UniformDirections = HemisphereDirections<render::UniformHemisphere>;
using CosineDirections = HemisphereDirections<render::CosineHemisphere>;

/// Directions as a sampler; evaluate() is L cos+ V, grey.
class DirectionSampler final : public Sampler {
 public:
  DirectionSampler(SharedSetting setting, SharedDirections directions)
      : setting_(std::move(setting)), directions_(std::move(directions)) {}

  Domain domain() const override { return directions_->domain(); }
  SamplerDraw sample(Stream& random) const override {
    const double u = random.uniform();
    const Direction d = directions_->draw(u, random.uniform());
    const Point point = point_of(d.w);
    const double value = evaluate(point);
    return {.point = point, .density = d.density, .weight = value == 0 ? 0 : value / d.density};
  }
  double density(const Point& p) const override {
    return directions_->density(render::vector_of(p));
  }
  double evaluate(const Point& p) const override {
    return setting_->grey(setting_->received(render::vector_of(p), Uncounted()));
  }
  Panels panels() const override { return directions_->panels(); }

 private:
  SharedSetting setting_;
  SharedDirections directions_;
};

struct Outcome {
  Rgb value;
  double below = 0;  ///< 1 if the direction lay below the horizon
  double nodes = 0;  ///< of a tree, that were passed through

  Outcome& operator+=(const Outcome& o) {
    return *this = {value + o.value, below + o.below, nodes + o.nodes};
  }
  Outcome operator/(double n) const { return {value / n, below / n, nodes / n}; }
};

/// L cos+ V / p.
inline Outcome outcome(const Setting& setting, const Direction& direction, Cost& cost) {
  Outcome result{.below = direction.w.z > 0 ? 0.0 : 1.0,
                 .nodes = static_cast<double>(direction.nodes)};
  if (direction.w.z <= 0) return result;
  result.value = setting.received(direction.w, cost) / direction.density;
  return result;
}

/// A primary: the mean over `strata` samples. The j-th has its first number in [j, j + 1) / strata.
/// `Follow` is Outcome(const Setting&, const Direction&, Cost&).
template <class Follow = decltype(&outcome)>
struct StratifiedPrimary {
  SharedSetting setting;
  SharedDirections directions;
  std::uint64_t strata;
  Follow follow = &outcome;

  Outcome operator()(Stream& random, Cost& cost) const {
    const auto k = static_cast<double>(strata);
    Outcome sum;
    for (std::uint64_t j = 0; j < strata; ++j) {
      const double u = (static_cast<double>(j) + random.uniform()) / k;
      sum += follow(*setting, directions->draw(u, random.uniform()), cost) / k;
    }
    cost.samples += strata;
    return sum;
  }
};

/// The mean of primaries, with the sampler `direction`. `channels` are one a colour; `diagnostic`
/// adds `below` and `nodes`, shares of an Outcome.
template <class Primary>
std::shared_ptr<const Setup> sky_setup(std::vector<Channel> channels, Primary primary,
                                       std::shared_ptr<const Sampler> sampler, bool diagnostic) {
  const std::size_t colours = channels.size();
  if (diagnostic) {
    channels.push_back({.name = "below", .low = 0, .high = 1, .diagnostic = true});
    channels.push_back({.name = "nodes", .low = 0, .diagnostic = true});
  }
  const auto estimate = [primary = std::move(primary), colours, diagnostic](
                            Stream& random, std::uint64_t primaries, std::span<double> out,
                            Cost& cost) {
    Outcome sum;
    for (std::uint64_t i = 0; i < primaries; ++i) sum += primary(random, cost);
    const Outcome mean = sum / static_cast<double>(primaries);
    for (std::size_t c = 0; c < colours; ++c) out[c] = mean.value[c];
    if (!diagnostic) return;
    out[colours] = mean.below;
    out[colours + 1] = mean.nodes;
  };
  return setup_of({.channels = std::move(channels),
                   .make = estimating(estimate),
                   .samplers = {{"direction", std::move(sampler)}}});
}

/// `strata`, of all estimators of the family.
inline ParameterInformation strata_parameter() {
  return count_parameter(
      "strata", "samples of a primary, the first of their two numbers stratified", "1", {1, 1e6});
}

}  // namespace assay::sky
