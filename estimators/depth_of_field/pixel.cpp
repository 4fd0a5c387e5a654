#include "depth_of_field/pixel.h"

#include "estimators/core/value.h"
#include "estimators/parameters.h"

namespace assay::depth_of_field {

ParameterInformation scene_parameter(const char* fallback) {
  return structure_parameter("scene",
                             "a built-in scene (edge, sinusoid, strip, portrait, boards), or a map "
                             "of lens, background and planes",
                             fallback);
}

SharedSetting read_setting(Parameters& given) {
  return std::make_shared<const Setting>(read_scene(given.structure("scene")));
}

ParameterInformation pixel_parameter() {
  return structure_parameter("pixel", "the point [x, y] of the focal plane that the pixel sees",
                             "[0, 0]", "scene units");
}

PlanePoint read_pixel(Parameters& given) {
  const Value& value = given.structure("pixel");
  given.require(value.items().size() == 2, "pixel",
                "must be a list of two numbers, x and y on the focal plane");
  return {finite_number(value.items()[0], "the pixel's x"),
          finite_number(value.items()[1], "the pixel's y")};
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

namespace assay::plugins {

std::vector<Entry> depth_of_field_pixel() {
  using namespace depth_of_field;
  return {
      {{.name = "depth_of_field/pixel",
        .summary = "The radiance at one pixel behind a thin lens, by points of the lens.",
        .description =
            "X = L(u, P): the radiance along the ray from a point u, uniform on the lens, through "
            "the point P of the focal plane that the pixel sees; one camera ray. Mean and "
            "variance are exact. Before a half-plane whose edge is at distance d from the middle "
            "of a disc of confusion of radius r the mean is c = 1 - (acos t - t sqrt(1 - t^2)) / "
            "pi, t = d / r, and the variance c (1 - c); of a wave cos(k x) the lens leaves 2 "
            "J1(k r) / (k r). r = radius |depth - focus| / focus on the plane at that depth. "
            "With `jitter: n` a primary is the mean of n^2 lens points, one in each cell of a "
            "grid. (Soler, Subr, Durand, Holzschuch and Sillion 2009, ACM Trans. Graph. 28(2), "
            "article 18.)",
        .parameters = {scene_parameter("edge"), pixel_parameter(),
                       count_parameter("jitter",
                                       "side n of the grid; 1 for independent lens points", "1",
                                       {1, 1024})}},
       prepare_pixel<>},
      {{.name = "depth_of_field/two_stage",
        .summary = "The radiance at one pixel, by as many lens points as a pilot asks for.",
        .description =
            "A pilot of lens samples gives their variance s^2; X is the mean of N = max(1, "
            "ceil(s^2 / noise^2)) further ones, at most `most`. As the pilot is not averaged "
            "with them, N does not depend on what is averaged, and X is unbiased; to average "
            "the pilot too is a bias (Kirk and Arvo 1991, \"Unbiased sampling techniques for "
            "image synthesis\"). The pilot's rays are counted.",
        .parameters = {scene_parameter("edge"), pixel_parameter(),
                       count_parameter("pilot", "lens samples of the pilot", "8", {2, 1e6}),
                       number_parameter("noise", "standard error that is asked for", "0.1",
                                        above(0), "radiance"),
                       count_parameter("most", "lens samples after the pilot, at most", "4096",
                                       {1, 1e6})}},
       [](Parameters& given) { return prepare_two_stage<>(given); }}};
}

}  // namespace assay::plugins
