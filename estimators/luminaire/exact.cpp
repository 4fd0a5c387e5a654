#include "luminaire/exact.h"

#include <algorithm>
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

// The integral of (z h / r^4)^2 over triangles at distance h from the origin, subdivided until
// refinement no longer matters.
class SquaredGeometry {
 public:
  explicit SquaredGeometry(double plane_distance) : h_(plane_distance) {}

  double of(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const Corners corners = {polygon[0], polygon[i], polygon[i + 1]};
      sum += refined(corners, quadrature(corners), 0);
    }
    return sum;
  }
  bool converged() const { return converged_; }

 private:
  using Corners = render::Corners;

  double refined(const Corners& t, double coarse, int depth) {
    const std::array<Corners, 4> parts = render::quartered(t);
    std::array<double, 4> values{};
    std::ranges::transform(parts, values.begin(), [&](const Corners& p) { return quadrature(p); });
    const double fine = values[0] + values[1] + values[2] + values[3];
    if (std::abs(fine - coarse) <= 1e-12 * fine) return fine;
    if (depth == 8) converged_ = false;
    if (!converged_) return fine;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += refined(parts[i], values[i], depth + 1);
    return sum;
  }

  // Duffy's map of the square to the triangle, whose area element is u.
  double quadrature(const Corners& t) const {
    static const auto nodes = render::gauss_legendre<16>();
    double sum = 0;
    for (const render::Node& u : nodes) {
      for (const render::Node& v : nodes) {
        const Vector3 p = t[0] + u.place * ((t[1] - t[0]) + v.place * (t[2] - t[1]));
        const double r2 = squared_length(p);
        const double term = p.z * h_ / (r2 * r2);
        sum += u.weight * v.weight * u.place * term * term;
      }
    }
    return sum * length(cross(t[1] - t[0], t[2] - t[0]));
  }

  double h_;
  bool converged_ = true;
};

double whole_solid_angle(const Setting& setting) {
  double sum = 0;
  for (const LightTriangle& t : setting.triangles()) {
    sum += render::solid_angle(t.a, t.a + t.ab, t.a + t.ac);
  }
  return sum;
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
  SquaredGeometry geometry(light.plane_distance);
  ExactIntegrals exact;
  exact.irradiance = sum(*parts, [](const Polygon& p) { return render::lambert(p, up); });
  exact.squared_cosine =
      sum(*parts, [](const Polygon& p) { return render::squared_cosine(p, up); });
  exact.solid_angle = whole_solid_angle(setting);
  exact.area = setting.area();
  const double squared = sum(*parts, [&](const Polygon& p) { return geometry.of(p); });
  if (geometry.converged()) exact.squared_geometry = squared;
  return exact;
}

double unclipped_irradiance(const Setting& setting) {
  return setting.radiance() * render::lambert(setting.polygon(), up);
}

}  // namespace assay::luminaire
