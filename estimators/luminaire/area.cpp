#include "luminaire/area.h"

#include "estimators/parameters.h"

namespace assay::luminaire {

namespace {

using render::Frame;

/// The middle of pixel `index` of `count` that divide a length into equal parts, from its middle.
double offset(std::size_t index, std::size_t count, double part) {
  return (static_cast<double>(index) + 0.5 - static_cast<double>(count) / 2) * part;
}

}  // namespace

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

Floor read_floor(Parameters& parameters) {
  SceneDescription scene = read_scene(parameters.structure("scene"), parameters.folder());
  Floor floor{.shape = {.width = parameters.count("width"),
                        .height = parameters.count("height"),
                        .components = {"irradiance"},
                        .independent = !parameters.boolean("shared")}};
  const double part = parameters.number("size") / static_cast<double>(floor.shape.width);
  const render::Vector3 centre = scene.receiver.position;
  const Frame frame = Frame::about(scene.receiver.normal);
  for (std::size_t y = 0; y < floor.shape.height; ++y) {
    for (std::size_t x = 0; x < floor.shape.width; ++x) {
      scene.receiver.position = centre + offset(x, floor.shape.width, part) * frame.tangent +
                                offset(y, floor.shape.height, part) * frame.bitangent;
      floor.settings.push_back(std::make_shared<const Setting>(scene, parameters.where("scene")));
    }
  }
  return floor;
}

std::vector<Channel> floor_channels(const Floor& floor) {
  const auto unknown = [](const ExactIntegrals&) { return std::optional<double>(); };
  return mapped(floor.settings, [&](const SharedSetting& setting) {
    // cos+ light_cosine+ / r^2 <= 1 / r^2, and r is at least the distance to the luminaire's plane.
    double nearest = std::numeric_limits<double>::infinity();
    for (const LightTriangle& triangle : setting->triangles()) {
      if (triangle.emits) nearest = std::min(nearest, triangle.plane_distance);
    }
    return irradiance_channel(*setting, unknown,
                              setting->area() * setting->radiance() / (nearest * nearest));
  });
}

}  // namespace assay::luminaire

namespace assay::plugins {

namespace {

using namespace luminaire;

std::shared_ptr<const Setup> floor_image(Parameters& parameters) {
  const Floor floor = read_floor(parameters);
  const auto primary = [](const SharedSetting& setting) { return AreaPrimary<>(setting); };
  return imaging<AreaPrimary<>>(
      {floor.shape, floor_channels(floor), mapped(floor.settings, primary)});
}

}  // namespace

std::vector<Entry> luminaire_area() {
  return {
      {information("luminaire/area", "Irradiance from a luminaire by points uniform on its area.",
                   "X = A L cos+(receiver) cos+(light) / r^2 [visible] at a point uniform on the "
                   "luminaire of area A. At most one shadow ray a sample: none where a cosine is "
                   "zero. Sampler (of a single triangle): point."),
       [](Parameters& parameters) {
         const SharedSetting setting = read_setting(parameters);
         return averaging(area_channel(*setting), AreaPrimary<>(setting),
                          point_samplers<>(setting));
       }},
      {{.name = "luminaire/floor",
        .summary = "An image: the irradiance of a plane under a luminaire, receiver by "
                   "receiver.",
        .description =
            "The estimator luminaire/area at each of width x height receivers on the plane of "
            "the scene's receiver, which is its middle. With `shared`, one set of points on "
            "the luminaire serves all receivers of an image, whose pixels are then correlated. "
            "Samples are counted per pixel; Lambert's formula knows every pixel's mean.",
        .parameters = {scene_parameter(),
                       count_parameter("width", "columns of receivers", "32", {2, 1024}),
                       count_parameter("height", "rows of receivers", "32", {2, 1024}),
                       number_parameter("size", "length of the plane's rectangle along the width",
                                        "4", above(0)),
                       boolean_parameter(
                           "shared", "whether all receivers use the same points of the luminaire",
                           false)}},
       floor_image}};
}

}  // namespace assay::plugins
