#include <algorithm>

#include "luminaire/floor.h"

namespace assay::luminaire {

namespace {

using render::Frame;
using render::Vector3;

/// The middle of pixel `index` of `count` that divide a length into equal parts, from its middle.
double offset(std::size_t index, std::size_t count, double part) {
  return (static_cast<double>(index) + 0.5 - static_cast<double>(count) / 2) * part;
}

/// cos+ light_cosine+ / r^2 <= 1 / r^2, and r is at least the distance to the luminaire's plane.
double highest(const Setting& setting) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const LightTriangle& triangle : setting.triangles()) {
    if (triangle.emits) nearest = std::min(nearest, triangle.plane_distance);
  }
  return setting.area() * setting.radiance() / (nearest * nearest);
}

}  // namespace

std::vector<ParameterInformation> floor_parameters() {
  std::vector<ParameterInformation> list = information("", "", "").parameters;
  list.push_back({.name = "width",
                  .type = ParameterType::count,
                  .summary = "columns of receivers",
                  .fallback = "32",
                  .low = 2,
                  .high = 1024});
  list.push_back({.name = "height",
                  .type = ParameterType::count,
                  .summary = "rows of receivers",
                  .fallback = "32",
                  .low = 2,
                  .high = 1024});
  list.push_back({.name = "size",
                  .summary = "length of the plane's rectangle along the width",
                  .fallback = "4",
                  .low = 0,
                  .low_excluded = true});
  list.push_back({.name = "shared",
                  .type = ParameterType::boolean,
                  .summary = "whether all receivers look at the same points of the luminaire",
                  .fallback = "false"});
  return list;
}

Floor read_floor(Parameters& parameters) {
  SceneDescription scene = read_scene(parameters.structure("scene"), parameters.folder());
  Floor floor{.shape = {.width = parameters.count("width"),
                        .height = parameters.count("height"),
                        .components = {"irradiance"}},
              .streams = parameters.boolean("shared") ? ImageStreams::shared : ImageStreams::own};
  const double part = parameters.number("size") / static_cast<double>(floor.shape.width);
  const Vector3 centre = scene.receiver.position;
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
  std::vector<Channel> channels;
  for (const SharedSetting& setting : floor.settings) {
    channels.push_back(irradiance_channel(*setting, unknown, highest(*setting)));
  }
  return channels;
}

}  // namespace assay::luminaire
