// Points of luminaires and directions of skies as sources of pairs.

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "correlated/estimators.h"
#include "estimators/parameters.h"
#include "luminaire/area.h"
#include "sky/directions.h"
#include "steerable/directions.h"

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

sky::SharedDirections directions_of(Parameters& given, const sky::Setting& setting) {
  const std::string sampling = given.string("sampling");
  if (sampling == "uniform") return std::make_shared<const sky::UniformDirections>();
  if (sampling == "cosine") return std::make_shared<const sky::CosineDirections>();
  // A lobe of one coefficient is constant: what is left is the sky alone.
  const steerable::Lobe lobe =
      sampling == "emittance" ? steerable::Lobe{.coefficients = 1, .offset = 0} : steerable::Lobe{};
  const auto tree = std::make_shared<const steerable::SkyTree>(
      setting.radiance(), steerable::Preparation{.coefficients = lobe.coefficients});
  given.require(tree->least() > 0, "sky",
                "is black at a vertex of the subdivision that `sampling: " + sampling +
                    "` draws by: some directions would never be drawn; sample it uniformly or by "
                    "the cosine");
  return std::make_shared<const steerable::SteeredDirections<>>(tree, lobe, setting.frame());
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

SharedPairs read_sky_pairs(Parameters& given) {
  const sky::SharedSetting setting = sky::read_setting(given);
  const sky::SharedDirections directions = directions_of(given, *setting);
  const Rgb mean = setting->radiance().mean();
  PairSource pairs{
      .colours = {},
      .draw =
          [setting, directions, mean](Stream& random, std::span<Pair> out, Cost& cost) {
            for (Pair& pair : out) {
              const double u = random.uniform();
              const sky::Direction direction = directions->draw(u, random.uniform());
              pair = {};
              if (direction.w.z <= 0) continue;
              pair.full = setting->received(direction.w, cost) / direction.density;
              pair.control = direction.w.z * mean / direction.density;
            }
          },
      .samplers = {{"direction", std::make_shared<sky::DirectionSampler>(setting, directions)}}};
  for (const Channel& channel : sky::irradiance_channels(*setting)) {
    pairs.colours.push_back({.name = channel.name,
                             .control_integral = std::numbers::pi * mean[pairs.colours.size()],
                             .integral = channel.mean,
                             .integral_error = channel.mean_error});
  }
  return std::make_shared<const PairSource>(std::move(pairs));
}

}  // namespace assay::correlated

namespace assay::plugins {

std::vector<Entry> correlated_pairs() {
  const correlated::Family sky{
      .name = "correlated/sky",
      .integral = "Irradiance from a sky",
      .description =
          "f is the irradiance that arrives from a direction of the sky, L cos+ V, g what would "
          "arrive from a uniform sky of the same mean radiance M if nothing stood in the way, M "
          "cos+; J = pi M. Directions are drawn as `sampling` says; by the cosine g/p = J is "
          "constant and corrects nothing. One shadow ray a primary, none below the horizon.",
      .parameters = joined(sky::parameters(),
                           {text_parameter("sampling", "the density of directions", "emittance",
                                           {"uniform", "cosine", "emittance", "steered"})}),
      .read = correlated::read_sky_pairs};
  std::vector<Entry> all = correlated::entries(
      {.name = "correlated/area",
       .integral = "Irradiance from a polygonal luminaire",
       .description =
           "f is the irradiance that arrives from a point of the luminaire, g what would arrive if "
           "nothing stood in the way: g/p = A L cos+(receiver) cos+(light) / r^2 at points uniform "
           "on its area A, f = g [visible]; J is Lambert's formula for the polygon clipped at the "
           "receiver's horizon. One shadow ray a primary, none where a cosine is zero.",
       .parameters = {luminaire::scene_parameter()},
       .read = correlated::read_area_pairs});
  for (const Entry& entry : correlated::entries(sky)) all.push_back(entry);
  return all;
}

}  // namespace assay::plugins
