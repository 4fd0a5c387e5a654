#include "depth_of_field/family.h"

#include <utility>

namespace assay::depth_of_field {

ParameterInformation scene_parameter(const char* fallback) {
  return {.name = "scene",
          .type = ParameterType::structure,
          .summary =
              "a built-in scene (edge, sinusoid, strip, portrait, boards), or a map of lens, "
              "background and planes",
          .fallback = fallback};
}

SharedSetting read_setting(Parameters& given) {
  return std::make_shared<const Setting>(read_scene(given.structure("scene")));
}

ParameterInformation pixel_parameter() {
  return {.name = "pixel",
          .type = ParameterType::structure,
          .summary = "the point [x, y] of the focal plane that the pixel sees",
          .unit = "scene units",
          .fallback = "[0, 0]"};
}

PlanePoint read_pixel(Parameters& given) {
  const Value& value = given.structure("pixel");
  if (value.kind() != Value::Kind::list || value.items().size() != 2) {
    given.refuse("pixel", "must be a list of two numbers, x and y on the focal plane");
  }
  const PlanePoint out{value.items()[0].number("the pixel's x"),
                       value.items()[1].number("the pixel's y")};
  if (!std::isfinite(out.x) || !std::isfinite(out.y)) given.refuse("pixel", "must be finite");
  return out;
}

Channel radiance_channel(const SceneDescription& scene, const Moments& moments, double samples) {
  const Interval range = scene.range();
  Channel channel{.name = "radiance",
                  .mean = moments.mean,
                  .mean_error = moments.error,
                  .low = range.low,
                  .high = range.high,
                  .rounding = range.high * 0x1p-40};
  // Rounding of the difference: 32 halves of a last place of the largest square.
  const double off = moments.variance_error() + 0x1p-48 * range.high * range.high;
  if (off <= 1e-8 * moments.variance()) channel.variance = moments.variance() / samples;
  return channel;
}

}  // namespace assay::depth_of_field
