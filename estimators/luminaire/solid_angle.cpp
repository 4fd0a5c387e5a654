// A polygon is a fan of spherical triangles, one of which is picked with probability Omega_k /
// Omega. Nothing is clipped at the horizon: directions below it contribute zero.

#include "luminaire/solid_angle.h"

#include <numbers>

#include "render/hemisphere.h"

namespace assay::luminaire {

std::vector<LitTriangle> lit_triangles(const Setting& setting) {
  std::vector<LitTriangle> list;
  for (const LightTriangle& t : setting.triangles()) {
    if (!t.emits) continue;
    LitTriangle lit{render::SphericalTriangle(t.a, t.a + t.ab, t.a + t.ac), t.normal,
                    t.plane_distance};
    // Edge on, as good as invisible: a solid angle that rounds to nothing has no directions.
    if (lit.seen.solid_angle() > 0) list.push_back(lit);
  }
  return list;
}

Domain domain_of(const std::vector<LitTriangle>& triangles) {
  const bool above = std::ranges::all_of(triangles, [](const LitTriangle& t) {
    return t.seen.a().z >= 0 && t.seen.b().z >= 0 && t.seen.c().z >= 0;
  });
  return above ? Domain::hemisphere : Domain::sphere;
}

const LitTriangle* containing(const std::vector<LitTriangle>& triangles, const render::Vector3& w) {
  const auto found =
      std::ranges::find_if(triangles, [&](const LitTriangle& t) { return t.seen.contains(w); });
  return found == triangles.end() ? nullptr : &*found;
}

Channel solid_angle_channel(const Setting& setting) {
  double omega = 0;
  for (const LitTriangle& triangle : lit_triangles(setting)) omega += triangle.seen.solid_angle();
  const auto second_moment = [](const ExactIntegrals& exact) {
    return exact.solid_angle * exact.squared_cosine;
  };
  return irradiance_channel(setting, second_moment, omega * setting.radiance());
}

}  // namespace assay::luminaire

namespace assay::plugins {

namespace {

using namespace luminaire;

constexpr double pi = std::numbers::pi;
constexpr double two_pi = 2 * pi;

/// Uniform in the projected hemisphere: the cosines cancel.
struct CosineDirections : render::CosineHemisphere {
  static constexpr double most = pi;
  static double value(double radiance, const render::Vector3&) { return pi * radiance; }
  static double second_moment(const ExactIntegrals& exact) { return pi * exact.irradiance; }
};

struct UniformDirections : render::UniformHemisphere {
  static constexpr double most = two_pi;
  static double value(double radiance, const render::Vector3& w) { return two_pi * radiance * w.z; }
  static double second_moment(const ExactIntegrals& exact) { return two_pi * exact.squared_cosine; }
};

template <class Directions>
struct Primary {
  SharedSetting setting;

  LightSample draw(Stream& random) const {
    const double u = random.uniform();
    const double v = random.uniform();
    const render::Vector3 w = Directions{}(u, v);
    return {setting->ray(w), Directions::value(setting->radiance(), w)};
  }
  double value(const LightSample& sample, Cost& cost) const {
    return setting->sees_light(sample.ray, cost) ? sample.value : 0;
  }
};

template <class Directions>
std::shared_ptr<const Setup> directions(Parameters& parameters) {
  const SharedSetting setting = read_setting(parameters);
  const auto point = [](Stream& random) -> std::optional<Point> {
    const double u = random.uniform();
    return point_of(Directions{}(u, random.uniform()));
  };
  const auto density = [](const Point& p) { return Directions{}.density(render::vector_of(p)); };
  const auto evaluate = [setting](const Point& p) {
    const bool lit = setting->sees_light(setting->ray(render::vector_of(p)), Uncounted());
    return lit ? setting->radiance() * p[2] : 0;
  };
  return averaging(irradiance_channel(*setting, Directions::second_moment,
                                      Directions::most * setting->radiance()),
                   Primary<Directions>{setting},
                   {{"direction", sampler_of({Domain::hemisphere, point, density, evaluate})}});
}

}  // namespace

std::vector<Entry> luminaire_solid_angle() {
  return {
      {information("luminaire/cosine",
                   "Irradiance from a luminaire by directions of density cos(theta) / pi.",
                   "X = pi L where a ray along a direction uniform in the projected hemisphere "
                   "first hits the emitting side of the luminaire, else 0: a Bernoulli variable "
                   "of variance E (pi L - E). One closest-hit ray a sample. Sampler: "
                   "direction."),
       directions<CosineDirections>},
      {information("luminaire/hemisphere",
                   "Irradiance from a luminaire by directions uniform in the hemisphere.",
                   "X = 2 pi L cos(theta) where a ray along a uniform direction (density "
                   "1 / (2 pi)) first hits the emitting side of the luminaire, else 0. One "
                   "closest-hit ray a sample. Sampler: direction."),
       directions<UniformDirections>},
      {information(
           "luminaire/solid_angle",
           "Irradiance from a luminaire by directions uniform in its solid angle.",
           "X = Omega L cos+ [visible] along a direction uniform in the solid angle Omega of "
           "the luminaire (Arvo 1995, Stratified sampling of spherical triangles). At most one "
           "shadow ray a sample: none below the horizon. Samplers: direction (of a polygon), "
           "square (of a single triangle: the numbers behind the direction, uniform)."),
       [](Parameters& parameters) {
         const SharedSetting setting = read_setting(parameters);
         return averaging(solid_angle_channel(*setting), SolidAnglePrimary<>(setting),
                          solid_angle_samplers<>(setting));
       }}};
}

}  // namespace assay::plugins
