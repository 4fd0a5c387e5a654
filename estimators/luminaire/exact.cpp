#include "luminaire/exact.h"

#include <array>
#include <functional>
#include <span>

#include "render/quadrature.h"

namespace assay::luminaire {

namespace {

using render::HalfSpace;
using render::Polygon;
using render::Vector3;

constexpr Vector3 up = {0, 0, 1};
constexpr std::size_t most_occluders = 8;

using Cone = std::vector<HalfSpace>;                       // their intersection
using Functional = std::function<double(const Polygon&)>;  // additive over parts

Polygon clipped(Polygon polygon, const Cone& cone) {
  for (const HalfSpace& half_space : cone) polygon = render::clipped(polygon, half_space);
  return polygon;
}

// Adds the part of a convex polygon that lies in none of the cones, by inclusion and exclusion.
void add_outside(std::vector<SignedPolygon>& parts, const SignedPolygon& whole,
                 std::span<const Cone> cones) {
  if (whole.polygon.empty()) return;
  if (cones.empty()) {
    parts.push_back(whole);
    return;
  }
  const std::span<const Cone> rest = cones.subspan(1);
  add_outside(parts, whole, rest);
  add_outside(parts, {clipped(whole.polygon, cones[0]), -whole.sign}, rest);
}

// The value of an additive functional for the sum of parts.
double sum(std::span<const SignedPolygon> parts, const Functional& functional) {
  double total = 0;
  for (const SignedPolygon& part : parts) total += part.sign * functional(part.polygon);
  return total;
}

// The pyramid from the origin through a convex polygon; no half spaces where it is seen edge on.
Cone pyramid(const Polygon& base) {
  Cone cone;
  const double side = dot(render::area_vector(base), base[0]);
  if (side == 0) return cone;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Vector3 across = cross(base[i], base[(i + 1) % base.size()]);
    cone.push_back({side > 0 ? across : -across, 0});
  }
  return cone;
}

bool nearer_than(const Polygon& polygon, double distance) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    if (render::distance_to_triangle(polygon[0], polygon[i], polygon[i + 1]) < distance)
      return true;
  }
  return false;
}

// The cones in which the occluders hide the luminaire; nullopt if they have no exact form.
std::optional<std::vector<Cone>> shadows(const Setting& setting) {
  const auto& occluders = setting.polygonal_occluders();
  if (!occluders || occluders->size() > most_occluders) return {};
  const LightTriangle& light = setting.triangles()[0];
  const HalfSpace in_front{light.normal, -(1 - 2 * resolution) * light.plane_distance};
  std::vector<Cone> cones;
  for (const Polygon& occluder : *occluders) {
    if (nearer_than(occluder, setting.near())) return {};
    const Polygon part = render::clipped(occluder, in_front);
    const Cone cone = part.empty() ? Cone{} : pyramid(part);
    if (!cone.empty()) cones.push_back(cone);
  }
  return cones;
}

// The integral of (z h / r^4)^2 over a sum of convex polygons at distance h from the origin;
// nullopt if refinement does not end.
std::optional<double> squared_geometry(std::span<const SignedPolygon> parts, double h) {
  const auto squared_term = [h](const Vector3& p) -> std::array<double, 1> {
    const double r2 = squared_length(p);
    const double term = p.z * h / (r2 * r2);
    return {term * term};
  };
  constexpr double tolerance = 1e-12;
  double total = 0;
  for (const auto& [polygon, sign] : parts) {
    render::TriangleQuadrature<1, decltype(squared_term)> quadrature(squared_term,
                                                                     {.tolerance = tolerance});
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      quadrature.add({polygon[0], polygon[i], polygon[i + 1]});
    }
    const render::Integrals<1> found = quadrature.refined();
    if (found.error[0] > tolerance * found.value[0]) return {};
    total += sign * found.value[0];
  }
  return total;
}

}  // namespace

std::optional<std::vector<SignedPolygon>> visible_parts(const Setting& setting) {
  if (!setting.planar()) return {};
  const auto cones = shadows(setting);
  if (!cones) return {};
  std::vector<SignedPolygon> parts;
  if (!setting.triangles()[0].emits) return parts;
  add_outside(parts, {render::clipped(setting.polygon(), {up, 0}), 1}, *cones);
  return parts;
}

std::optional<ExactIntegrals> exact_integrals(const Setting& setting) {
  const auto parts = visible_parts(setting);
  if (!parts) return {};
  const LightTriangle& light = setting.triangles()[0];
  if (!light.emits) return ExactIntegrals{.area = setting.area(), .squared_geometry = 0};
  ExactIntegrals exact;
  exact.irradiance = sum(*parts, [](const Polygon& p) { return render::lambert(p, up); });
  exact.squared_cosine =
      sum(*parts, [](const Polygon& p) { return render::squared_cosine(p, up); });
  for (const LightTriangle& t : setting.triangles()) {
    exact.solid_angle += render::solid_angle(t.a, t.a + t.ab, t.a + t.ac);
  }
  exact.area = setting.area();
  exact.squared_geometry = squared_geometry(*parts, light.plane_distance);
  return exact;
}

Channel irradiance_channel(const Setting& setting, const SecondMoment& second_moment, double high) {
  Channel channel{.name = "irradiance", .low = 0, .high = high};
  const std::optional<ExactIntegrals> exact = exact_integrals(setting);
  if (!exact) return channel;
  const double l = setting.radiance();
  const double mean = l * exact->irradiance;
  channel.mean = mean;
  const std::optional<double> of_unit_radiance = second_moment(*exact);
  if (!of_unit_radiance) return channel;
  const double square = *of_unit_radiance * (l * l);
  const double variance = square - mean * mean;
  // Both terms are good to about 1e-15; the difference must be so to 1e-10. Nothing seen is exact.
  if (square == 0 || variance >= 1e-5 * square) channel.variance = variance;
  return channel;
}

double unclipped_irradiance(const Setting& setting) {
  return setting.radiance() * render::lambert(setting.polygon(), up);
}

}  // namespace assay::luminaire
