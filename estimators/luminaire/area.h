#pragma once

// The parts of the estimator by points uniform on the luminaire's area.

#include <algorithm>
#include <utility>

#include "estimators/core/mapped.h"
#include "luminaire/exact.h"
#include "render/share_table.h"

namespace assay::luminaire {

/// A point a + u (b - a) + v (c - a) of a triangle.
struct Barycentric {
  double u;
  double v;
};

/// Uniform in the triangle: u = 1 - sqrt(x), v = y sqrt(x) (Turk 1990).
struct UniformTriangle {
  Barycentric operator()(double x, double y) const {
    const double root = std::sqrt(x);
    return {1 - root, y * root};
  }
};

/// cos+ light_cosine+ / distance^2: the integrand per unit area for unit radiance, but for
/// visibility. The cosines are heights over the distance.
struct GeometryTerm {
  double operator()(const Connection& c) const {
    return std::max(0.0, c.receiver_height()) * std::max(0.0, c.light_height) /
           (c.squared_distance * c.squared_distance);
  }
};

/// X = area L term(connection) [visible]. `Warp` gives the point, `Term` the integrand.
template <class Warp = UniformTriangle, class Term = GeometryTerm>
class AreaPrimary {
 public:
  explicit AreaPrimary(SharedSetting setting, Term term = {})
      : setting_(std::move(setting)),
        shares_(mapped(setting_->triangles(), &LightTriangle::area)),
        factor_(setting_->area() * setting_->radiance()),
        term_(term) {}

  LightSample draw(Stream& random) const {
    const auto [index, x, y] = shares_.choose(random);
    return at(setting_->triangles()[index], Warp{}(x, y));
  }

  double value(const LightSample& sample, Cost& cost) const {
    return setting_->received(sample, cost);
  }

  LightSample at(const LightTriangle& triangle, const Barycentric& point) const {
    const Connection connection = setting_->connect(triangle, point.u, point.v);
    return {shadow_ray(connection.to_light), factor_ * term_(connection)};
  }

  const Setting& setting() const { return *setting_; }
  const render::ShareTable& shares() const { return shares_; }

 private:
  SharedSetting setting_;
  render::ShareTable shares_;
  double factor_;
  Term term_;
};

/// `point`, where the luminaire is one triangle: density 2 on the triangle of (u, v).
template <class Warp = UniformTriangle>
std::vector<NamedSampler> point_samplers(const SharedSetting& setting) {
  if (setting->triangles().size() != 1) return {};
  const auto point = [](Stream& random) {
    const double x = random.uniform();
    const auto [u, v] = Warp{}(x, random.uniform());
    return u + v <= 1 ? std::optional(Point{u, v}) : std::nullopt;
  };
  const auto density = [](const Point& p) -> double {
    return p[0] >= 0 && p[1] >= 0 && p[0] + p[1] <= 1 ? 2 : 0;
  };
  const auto evaluate = [primary = AreaPrimary<>(setting)](const Point& p) {
    const LightTriangle& triangle = primary.setting().triangles()[0];
    return 2 * primary.value(primary.at(triangle, {p[0], p[1]}), Uncounted());
  };
  return {{"point", sampler_of({Domain::triangle, point, density, evaluate})}};
}

/// The channel of the sound estimator.
Channel area_channel(const Setting& setting);

// The image of a plane's irradiance: the estimator at each of a grid of receivers.

/// The grid: width x height receivers that share the scene's normal. They are the centres of equal
/// squares. The rectangle is centred on the scene's receiver and `size` long along the width.
struct Floor {
  ImageShape shape;
  std::vector<SharedSetting> settings;  ///< of each pixel, row by row
};

/// Reads scene, width, height, size, shared.
Floor read_floor(Parameters& parameters);

/// Channels with Lambert's mean, between 0 and the most that any point can bring.
std::vector<Channel> floor_channels(const Floor& floor);

}  // namespace assay::luminaire
