// The radiance that a thin lens gathers at one pixel.
//
// X = L(u, P) is the radiance along a ray. It goes from a lens point u, uniform on the disc,
// through the pixel's point P of the focal plane. E[X] is the average of L over the lens. Both E[X]
// and Var X are known in closed form or by quadrature (exact.h).

#include "depth_of_field/pixel.h"

namespace assay::depth_of_field {

Information pixel_information() {
  return {
      .name = "depth_of_field/pixel",
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
      .parameters = {scene_parameter("edge"),
                     pixel_parameter(),
                     {.name = "jitter",
                      .type = ParameterType::count,
                      .summary = "side n of the grid; 1 for independent lens points",
                      .fallback = "1",
                      .low = 1,
                      .high = 1024}}};
}

}  // namespace assay::depth_of_field

namespace assay::plugins {

std::vector<Entry> depth_of_field_pixel() {
  return {{depth_of_field::pixel_information(), depth_of_field::prepare_pixel<>}};
}

}  // namespace assay::plugins
