#include "luminaire/family.h"

#include <utility>

namespace assay::luminaire {

ParameterInformation scene_parameter() {
  return structure_parameter(
      "scene",
      "a built-in scene (triangle, cornell_triangle, rectangle), or receiver, light and "
      "occluders: `{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {obj: lamp.obj}, "
      "occluders: [{obj: chair.obj}]}`",
      "triangle");
}

Information information(std::string name, std::string summary, std::string description) {
  return {.name = std::move(name),
          .summary = std::move(summary),
          .description = std::move(description),
          .parameters = {scene_parameter()}};
}

SharedSetting read_setting(Parameters& parameters) {
  const SceneDescription scene = read_scene(parameters.structure("scene"), parameters.folder());
  return std::make_shared<const Setting>(scene, parameters.where("scene"));
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

}  // namespace assay::luminaire
