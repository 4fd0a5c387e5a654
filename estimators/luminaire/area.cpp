#include "luminaire/area.h"

namespace assay::luminaire {

Channel area_channel(const Setting& setting) {
  const auto second_moment = [](const ExactIntegrals& exact) {
    std::optional<double> moment = exact.squared_geometry;
    if (moment) *moment *= exact.area;
    return moment;
  };
  // Rays see nothing nearer than a shortest distance. At distance h from a triangle's plane
  // light_cosine / r^2 = h / r^3, and r is at least h and at least that distance.
  const double least = setting.near() / resolution;
  double highest = 0;
  for (const LightTriangle& triangle : setting.triangles()) {
    highest = std::max(highest, triangle.plane_distance / (least * least * least));
  }
  return irradiance_channel(setting, second_moment, setting.area() * setting.radiance() * highest);
}

}  // namespace assay::luminaire

namespace assay::plugins {

std::vector<Entry> luminaire_area() {
  using namespace luminaire;
  return {
      {information("luminaire/area", "Irradiance from a luminaire by points uniform on its area.",
                   "X = A L cos+(receiver) cos+(light) / r^2 [visible] at a point uniform on the "
                   "luminaire of area A. At most one shadow ray a sample: none where a cosine is "
                   "zero. Sampler (of a single triangle): point."),
       [](Parameters& parameters) {
         const SharedSetting setting = read_setting(parameters);
         return averaging(area_channel(*setting), AreaPrimary<>(setting),
                          point_samplers<>(setting));
       }}};
}

}  // namespace assay::plugins
