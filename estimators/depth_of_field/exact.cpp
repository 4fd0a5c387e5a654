#include "depth_of_field/exact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/quadrature.h"

namespace assay::depth_of_field {

namespace {

constexpr double pi = std::numbers::pi;

/// A plane as the lens sees it: where its edges are in lens coordinates.
struct Seen {
  const Plane* plane;
  Footprint map;
};

/// In lens coordinates the places where u (or v) crosses an edge of the interval; none in focus.
void add_edges(std::vector<double>& edges, const Interval& side, double scale, double offset) {
  if (scale == 0) return;
  for (const double x : {side.low, side.high}) {
    const double edge = (x - offset) / scale;
    if (std::abs(edge) < 1) edges.push_back(edge);
  }
}

/// A pixel's view through the lens.
class View {
 public:
  View(const SceneDescription& scene, const PlanePoint& pixel) : background_(scene.background) {
    for (const Plane& plane : scene.planes) {
      seen_.push_back({&plane, footprint(scene.lens, pixel, plane.depth)});
      const Footprint& map = seen_.back().map;
      add_edges(across_, plane.x, map.scale, map.offset.x);
      add_edges(along_, plane.y, map.scale, map.offset.y);
    }
    std::ranges::sort(across_);
  }

  Moments moments() const {
    if (!across_.empty() || !along_.empty()) return quadrature();
    // One surface fills the whole lens.
    const Seen* const seen = first({});
    if (!seen) return {background_, background_ * background_, 0};
    return sinusoid_moments(seen->plane->texture, seen->map);
  }

 private:
  const Seen* first(const PlanePoint& u) const {
    for (const Seen& seen : seen_) {
      if (seen.plane->contains(seen.map.at(u))) return &seen;
    }
    return nullptr;
  }

  /// Integrals of the radiance and its square along the chord of the lens at height v.
  std::array<double, 2> chord(double v) const {
    const double half = std::sqrt(std::max(0.0, 1 - v * v));
    std::array<double, 2> sum{};
    double from = -half;
    for (const double edge : across_) {
      if (edge <= from) continue;
      if (edge >= half) break;
      add(sum, {from, edge}, v);
      from = edge;
    }
    add(sum, {from, half}, v);
    return sum;
  }

  Moments quadrature() const {
    // Angles t, v = sin t, between which chord() is smooth.
    std::vector<double> breaks{-pi / 2, pi / 2};
    for (const double v : along_) breaks.push_back(std::asin(v));
    for (const double u : across_) {
      // The circle meets the edge here.
      breaks.push_back(std::acos(std::abs(u)));
      breaks.push_back(-breaks.back());
    }
    const auto integrand = [&](double t) {
      auto sums = chord(std::sin(t));
      for (double& x : sums) x *= std::cos(t) / pi;
      return sums;
    };
    const auto all = render::tanh_sinh_pieces<2>(integrand, breaks, 1e-12);
    return {all.value[0], all.value[1], std::max(all.error[0], all.error[1])};
  }

  void add(std::array<double, 2>& sum, const Interval& part, double v) const {
    const double length = part.high - part.low;
    const double middle = (part.low + part.high) / 2;
    const Seen* const seen = first({middle, v});
    const double m = seen ? seen->plane->texture.mean : background_;
    double wave = 0;    // integral of cos
    double square = 0;  // of cos^2
    const double a = seen ? seen->plane->texture.amplitude : 0;
    if (a > 0) {
      // The mean of cos over an interval is cos at its middle times a sinc.
      const Texture& texture = seen->plane->texture;
      const double k = texture.frequency * seen->map.scale;
      const double phase = k * middle + texture.frequency * seen->map.offset.x + texture.phase;
      const auto sinc = [](double z) { return z == 0 ? 1 : std::sin(z) / z; };
      wave = length * std::cos(phase) * sinc(k * length / 2);
      square = length * (1 + std::cos(2 * phase) * sinc(k * length)) / 2;
    }
    sum[0] += m * length + a * wave;
    sum[1] += m * m * length + 2 * m * a * wave + a * a * square;
  }

  double background_;
  std::vector<Seen> seen_;
  std::vector<double> across_;  // edges in u
  std::vector<double> along_;   // edges in v
};

}  // namespace

double half_plane_coverage(double d) {
  if (d <= -1) return 0;
  if (d >= 1) return 1;
  return 1 - (std::acos(d) - d * std::sqrt(1 - d * d)) / pi;
}

double disc_response(double z) {
  const double size = std::abs(z);
  // Below, 1 - z^2 / 8 is 1.
  return size < 1e-9 ? 1 : 2 * std::cyl_bessel_j(1.0, size) / size;
}

Moments sinusoid_moments(const Texture& texture, const Footprint& seen) {
  const double m = texture.mean;
  const double a = texture.amplitude;
  if (a == 0) return {m, m * m, 0};
  const double phase = texture.frequency * seen.offset.x + texture.phase;
  const double reach = texture.frequency * seen.scale;
  const double wave = std::cos(phase) * disc_response(reach);
  return {
      m + a * wave,
      m * m + 2 * m * a * wave + a * a / 2 * (1 + std::cos(2 * phase) * disc_response(2 * reach)),
      0};
}

Moments exact_moments(const SceneDescription& scene, const PlanePoint& pixel) {
  return View(scene, pixel).moments();
}

}  // namespace assay::depth_of_field
