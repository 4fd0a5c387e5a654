#pragma once

// The parts of the estimator by points uniform on the luminaire's area.

#include <algorithm>
#include <utility>

#include "luminaire/family.h"

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
/// visibility.
struct GeometryTerm {
  double operator()(const Connection& c) const {
    return std::max(0.0, c.direction.z) * std::max(0.0, c.light_cosine) / (c.distance * c.distance);
  }
};

/// X = area L term(connection) [visible]. `Warp` gives the point, `Term` the integrand.
template <class Warp = UniformTriangle, class Term = GeometryTerm>
class AreaPrimary {
 public:
  explicit AreaPrimary(SharedSetting setting, Term term = {})
      : setting_(std::move(setting)),
        shares_(areas(*setting_)),
        factor_(setting_->area() * setting_->radiance()),
        term_(term) {}

  double operator()(Stream& random, Cost& cost) const {
    double x = random.uniform();
    const double y = random.uniform();
    const LightTriangle& triangle = setting_->triangles()[shares_.pick(x)];
    return at(triangle, Warp{}(x, y), cost);
  }

  /// X for that point.
  double at(const LightTriangle& triangle, const Barycentric& point, Cost& cost) const {
    const Connection connection = setting_->connect(triangle, point.u, point.v);
    const double value = term_(connection);
    // Where the integrand vanishes nobody needs the ray.
    if (value == 0) return 0;
    const bool seen = setting_->visible(connection.direction, connection.distance, cost);
    return seen ? factor_ * value : 0;
  }

  const Setting& setting() const { return *setting_; }
  const ShareTable& shares() const { return shares_; }

 private:
  static std::vector<double> areas(const Setting& setting) {
    std::vector<double> list;
    for (const LightTriangle& triangle : setting.triangles()) list.push_back(triangle.area);
    return list;
  }

  SharedSetting setting_;
  ShareTable shares_;
  double factor_;
  Term term_;
};

/// The points of a luminaire that is one triangle: density 2 on the triangle of (u, v).
template <class Warp = UniformTriangle>
class PointSampler final : public Sampler {
 public:
  explicit PointSampler(SharedSetting setting) : primary_(std::move(setting)) {}

  Domain domain() const override { return Domain::triangle; }

  SamplerDraw sample(Stream& random) const override {
    const double x = random.uniform();
    const double y = random.uniform();
    const auto [u, v] = Warp{}(x, y);
    const Point point = {u, v, 0};
    return {.point = point,
            .density = density(point),
            .weight = evaluate(point) / 2,
            .valid = u + v <= 1};
  }

  double density(const Point& p) const override {
    return p[0] >= 0 && p[1] >= 0 && p[0] + p[1] <= 1 ? 2 : 0;
  }

  double evaluate(const Point& p) const override {
    Cost uncounted;
    return 2 * primary_.at(primary_.setting().triangles()[0], {p[0], p[1]}, uncounted);
  }

 private:
  AreaPrimary<> primary_;
};

/// `point`, where the luminaire is one triangle.
template <class Warp = UniformTriangle>
std::vector<NamedSampler> point_samplers(const SharedSetting& setting) {
  if (setting->triangles().size() != 1) return {};
  return {{"point", std::make_shared<PointSampler<Warp>>(setting)}};
}

/// The channel of the sound estimator.
Channel area_channel(const Setting& setting);

}  // namespace assay::luminaire
