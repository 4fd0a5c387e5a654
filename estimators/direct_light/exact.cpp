#include "direct_light/exact.h"

#include <algorithm>
#include <array>
#include <vector>

#include "luminaire/exact.h"
#include "render/quadrature.h"

namespace assay::direct_light {

namespace {

using render::Corners;
using render::Polygon;
using render::Vector3;

// More than a second's work to integrate over.
constexpr std::size_t most_parts = 20000;

// True if a triangle is seen within two widths of the lobe about its middle, at distances that
// differ threefold at most. Nodes are then at most 0.6 widths apart, less than the lobe's standard
// deviation.
bool small_enough(const Corners& t, double width) {
  const Vector3 middle = normalised(t[0] + t[1] + t[2]);
  const auto within = [&](const Vector3& p) { return length(normalised(p) - middle) <= 2 * width; };
  return std::ranges::all_of(t, within) &&
         render::diameter({t[0], t[1], t[2]}) <= 2 * render::distance_to_triangle(t[0], t[1], t[2]);
}

// The fan of a polygon, quartered until all parts are small enough; appended to `parts`, whose
// number ends beyond most_parts where that takes too many.
void split(const Polygon& polygon, double width, std::vector<Corners>& parts) {
  std::vector<Corners> left;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    left.push_back({polygon[0], polygon[i], polygon[i + 1]});
  }
  while (!left.empty() && parts.size() <= most_parts) {
    const Corners triangle = left.back();
    left.pop_back();
    if (small_enough(triangle, width)) {
      parts.push_back(triangle);
    } else {
      for (const Corners& part : render::quartered(triangle)) left.push_back(part);
    }
  }
}

// The integral over luminaire::visible_parts() of f(w) with respect to solid angle. There is none
// where the lobe is too narrow to be looked for everywhere.
template <std::size_t N, class F>
std::optional<render::Integrals<N>> over_visible(const Techniques& techniques, const F& f,
                                                 const std::array<std::size_t, N>& groups) {
  const auto visible = luminaire::visible_parts(techniques.setting());
  if (!visible) return {};
  const double height = techniques.setting().triangles()[0].plane_distance;
  const auto by_area = [&](const Vector3& p) {
    const double distance = length(p);
    std::array<double, N> y = f(p / distance);
    for (double& component : y) component *= height / (distance * distance * distance);
    return y;
  };
  render::Integrals<N> total;
  for (const auto& [polygon, sign] : *visible) {
    std::vector<Corners> parts;
    split(polygon, techniques.reflectance().width(), parts);
    if (parts.size() > most_parts) return {};
    render::TriangleQuadrature<N, decltype(by_area)> quadrature(
        by_area, {.most = 10000 + 4 * parts.size(), .group = groups});
    for (const Corners& part : parts) quadrature.add(part);
    render::Integrals<N> integrals = quadrature.refined();
    for (double& value : integrals.value) value *= sign;
    total += integrals;
  }
  return total;
}

}  // namespace

Channel mean_channel(const std::optional<Known>& radiance) {
  Channel channel{.name = "radiance"};
  if (radiance) {
    channel.mean = radiance->value;
    channel.mean_error = radiance->error;
  }
  return channel;
}

Known Moments::multi_sample_variance(const Counts& counts) const {
  const auto& [value, error] = integrals_;
  const Pair n = counts.shares();
  return {(value[1] - value[3] * value[3]) / n.light + (value[2] - value[4] * value[4]) / n.brdf,
          (error[1] + 2 * value[3] * error[3]) / n.light +
              (error[2] + 2 * value[4] * error[4]) / n.brdf};
}

Known Moments::one_sample_variance(const Pair& probabilities) const {
  const auto& [value, error] = integrals_;
  Known variance{-value[0] * value[0], 2 * value[0] * error[0]};
  const auto add = [&](std::size_t i, double probability) {
    if (probability == 0) return;
    variance.value += value[i] / probability;
    variance.error += error[i] / probability;
  };
  add(1, probabilities.light);
  add(2, probabilities.brdf);
  return variance;
}

std::optional<Moments> moments(const Techniques& techniques,
                               const WeightedByHeuristic& combination) {
  const auto integrands = [&](const Vector3& w) -> std::array<double, 5> {
    const double f = techniques.integrand(w);
    if (f == 0) return {};
    const Pair p = techniques.density(techniques.setting().triangles()[0], w);
    const Pair weight = combination.weights(p);
    const Pair part{weight.light * f, weight.brdf * f};
    // If the density of the BRDF underflows, so does f: their ratio is bounded.
    const double of_brdf = p.brdf > 0 ? part.brdf * part.brdf / p.brdf : 0;
    return {f, part.light * part.light / p.light, of_brdf, part.light, part.brdf};
  };
  const auto total = over_visible<5>(techniques, integrands, {0, 1, 1, 0, 0});
  if (!total) return {};
  return Moments(*total);
}

std::optional<Known> radiance(const Techniques& techniques) {
  const double l = techniques.setting().radiance();
  if (const auto constant = techniques.reflectance().constant()) {
    const auto exact = luminaire::exact_integrals(techniques.setting());
    if (!exact) return {};
    return Known{*constant * l * exact->irradiance, 0};
  }
  const auto integrand = [&](const Vector3& w) {
    return std::array<double, 1>{techniques.integrand(w)};
  };
  const auto total = over_visible<1>(techniques, integrand, {});
  if (!total) return {};
  return Known{total->value[0], total->error[0]};
}

}  // namespace assay::direct_light
