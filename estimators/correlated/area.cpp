#include "luminaire/area.h"

#include <stdexcept>

#include "correlated/estimators.h"

namespace assay::correlated {

namespace {

using luminaire::SceneDescription;
using luminaire::Setting;

Colour colour_of(const Setting& setting, const Setting& open) {
  const auto control = luminaire::exact_integrals(open);
  if (!control) throw std::invalid_argument("area_pairs: the luminaire must be a planar polygon");
  const double l = setting.radiance();
  Colour colour{.name = "irradiance", .control_integral = l * control->irradiance};
  const auto full = luminaire::exact_integrals(setting);
  if (!full) return colour;
  colour.integral = l * full->irradiance;
  if (!full->squared_geometry || !control->squared_geometry) return colour;
  const double factor = full->area * l * l;
  const double seen = factor * *full->squared_geometry;
  colour.moments = {.full = seen, .product = seen, .control = factor * *control->squared_geometry};
  return colour;
}

}  // namespace

SharedPairs area_pairs(const SceneDescription& description, const Location& where) {
  const auto setting = std::make_shared<const Setting>(description, where);
  const auto draw = [primary = luminaire::AreaPrimary<>(setting)](Stream& random,
                                                                  std::span<Pair> out, Cost& cost) {
    // Points first, rays after: see Averaging.
    std::array<luminaire::LightSample, 32> points;
    for (std::size_t done = 0; done < out.size(); done += points.size()) {
      const std::size_t size = std::min(points.size(), out.size() - done);
      for (std::size_t i = 0; i < size; ++i) points[i] = primary.draw(random);
      for (std::size_t i = 0; i < size; ++i) {
        out[done + i].control[0] = points[i].value;
        out[done + i].full[0] = primary.value(points[i], cost);
      }
    }
  };
  SceneDescription open = description;
  open.occluders.clear();
  return std::make_shared<const PairSource>(
      PairSource{.colours = {colour_of(*setting, Setting(open, where))},
                 .draw = draw,
                 .samplers = luminaire::point_samplers<>(setting)});
}

SharedPairs read_area_pairs(Parameters& given) {
  const SceneDescription scene = luminaire::read_scene(given.structure("scene"), given.folder());
  given.require(std::holds_alternative<render::Polygon>(scene.light.shape), "scene",
                "the luminaire must be one polygon: of a mesh, which may shade itself, the "
                "integral of the control is not known in closed form");
  return area_pairs(scene, given.where("scene"));
}

}  // namespace assay::correlated

namespace assay::plugins {

std::vector<Entry> correlated_area() {
  return correlated::entries(
      {.name = "correlated/area",
       .integral = "Irradiance from a polygonal luminaire",
       .description =
           "f is the irradiance that arrives from a point of the luminaire, g what would arrive if "
           "nothing stood in the way: g/p = A L cos+(receiver) cos+(light) / r^2 at points uniform "
           "on its area A, f = g [visible]; J is Lambert's formula for the polygon clipped at the "
           "receiver's horizon. One shadow ray a primary, none where a cosine is zero.",
       .parameters = {luminaire::scene_parameter()},
       .read = correlated::read_area_pairs});
}

}  // namespace assay::plugins
