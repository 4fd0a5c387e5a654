// The radiance that a thin lens gathers of a wave that it sees in a curved, rough mirror.
//
// E[X] and Var X follow from the wave's frequency (spectrum.h). The place on the board must be
// linear in the lens point, the pixel and the change of slope. Rays of the parabola are linear only
// in the limit of a small lens.

#include <numbers>

#include "analytic/law.h"
#include "depth_of_field/curved_mirror.h"
#include "depth_of_field/exact.h"
#include "depth_of_field/scene_description.h"
#include "depth_of_field/spectrum.h"
#include "estimators/parameters.h"

namespace assay::plugins {

namespace {

using namespace depth_of_field;

struct Reflection {
  Lens lens;
  CurvedMirror mirror;
  double roughness = 0;
  double pixel = 0;
  Texture board;
  bool exact = false;

  double operator()(Stream& random) const {
    const double u = lens.radius * lens_point(random).x;
    const double turned = analytic::NormalLaw{0, roughness}(random);
    return board.at(exact ? mirror.exact(lens, u, pixel, turned)
                          : mirror.linear(lens, u, pixel, turned));
  }

  /// The rest of a wave `times` as fast as the board's, averaged over lens and lobe.
  double left(double times) const {
    const CameraFrequency wave = Spectrum({{times * board.frequency, 0, 1}})
                                     .travel(mirror.beyond)
                                     .reflect(roughness)
                                     .curve(2 * mirror.curvature)
                                     .travel(mirror.distance)
                                     .at_camera(lens)[0];
    return std::sqrt(wave.power) * disc_response(lens.radius * wave.lens) *
           std::cos(wave.image * pixel + times * board.phase);
  }
};

Channel channel(const Reflection& reflection) {
  Channel out{.name = "radiance", .low = 0, .high = 1, .rounding = 0x1p-40};
  if (reflection.exact) return out;
  const double wave = reflection.left(1);
  out.mean = 0.5 + 0.5 * wave;
  // (1 + cos 2) / 8 of the square, less the square of the mean.
  const double variance = (1 + reflection.left(2)) / 8 - wave * wave / 4;
  // Numbers near 1/4 cancel to an error of 1e-16: below 1e-7 the ninth digit would be rounding.
  if (variance > 1e-7) out.variance = variance;
  return out;
}

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const Reflection reflection{
      .lens = {.radius = given.number("radius"), .focus = given.number("focus")},
      .mirror = {.distance = given.number("distance"),
                 .beyond = given.number("beyond"),
                 .curvature = given.number("curvature")},
      .roughness = given.number("roughness"),
      .pixel = given.number("pixel"),
      .board = {.mean = 0.5,
                .amplitude = 0.5,
                .frequency = 2 * std::numbers::pi / given.number("wavelength"),
                .phase = given.number("phase")},
      .exact = given.string("rays") == "exact"};
  given.require(
      !reflection.exact || reflection.mirror.returns_all(reflection.lens, reflection.pixel),
      "curvature", "rays from the lens may miss so curved a mirror, or not come back from it");
  return averaging(channel(reflection), reflection, lens_samplers());
}

ParameterInformation length(const char* name, const char* summary, const char* fallback) {
  return number_parameter(name, summary, fallback, above(0), "scene units");
}

}  // namespace

std::vector<Entry> depth_of_field_mirror() {
  return {
      {{.name = "depth_of_field/mirror",
        .summary = "A wave on a board, seen by a thin lens in a curved, rough mirror.",
        .description =
            "X = 1/2 + 1/2 cos(2 pi x / wavelength + phase), x where the ray from a point of the "
            "lens through the pixel ends on the board after a reflection, its slope changed by a "
            "normal number of the standard deviation `roughness`. Carried by frequencies, (k, 0) "
            "becomes by travel over `beyond` (k, -k beyond); by a mirror of curvature c position "
            "frequency grows by 2 c k beyond, a shear; by its roughness the amplitude is times "
            "exp(-(roughness k beyond)^2 / 2), which takes angular frequencies away; by travel "
            "over `distance` and the lens it has the frequency W = k (1 + 2 c beyond) - k (beyond "
            "+ distance (1 + 2 c beyond)) / focus across the lens, which leaves 2 J1(radius W) / "
            "(radius W) of it. Mean and variance are exact with `rays: linear`; `rays: exact` "
            "reflects at the parabola z = distance + c x^2 / 2, for which nothing is stated. No "
            "rays are traced. (Durand, Holzschuch, Soler, Chan and Sillion 2005; Soler, Subr, "
            "Durand, Holzschuch and Sillion 2009.) Sampler: lens.",
        .parameters =
            {length("radius", "of the lens", "0.2"),
             length("focus", "depth of what is sharp, from the lens along the ray", "2"),
             length("distance", "from the lens to the mirror", "1"),
             length("beyond", "from the mirror to the board", "3"),
             number_parameter("curvature", "of the mirror, positive where it bulges; 0 is flat",
                              "0", {}, "1 / scene unit"),
             number_parameter("roughness",
                              "standard deviation of the slopes about the mirror's; 0 is smooth",
                              "0", {0}),
             length("wavelength", "of the board", "0.41887902047863907"),
             number_parameter("phase", "of the board", "0", {}, "radians"),
             number_parameter("pixel", "the point of the focal plane that the pixel sees", "0", {},
                              "scene units"),
             text_parameter("rays",
                            "carried to first order about the axis, or by the law of reflection",
                            "linear", {"linear", "exact"})}},
       prepare}};
}

}  // namespace assay::plugins
