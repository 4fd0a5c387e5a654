// A polygon is a fan of spherical triangles, one of which is picked with probability Omega_k /
// Omega. Nothing is clipped at the horizon: directions below it contribute zero.

#include "luminaire/solid_angle.h"

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

std::vector<Entry> luminaire_solid_angle() {
  using namespace luminaire;
  return {{information(
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
