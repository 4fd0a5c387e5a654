// The irradiance of a plane under a luminaire, as an image.
//
// Pixel (x, y) is the receiver at the middle of its square. At points uniform on the luminaire it
// has X = A L cos+ light_cosine+ / r^2 [visible]. E[X] is that receiver's irradiance, known by
// Lambert's formula.

#include "luminaire/floor.h"

namespace assay::plugins {

namespace {

using namespace luminaire;

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const Floor floor = read_floor(parameters);
  std::vector<AreaPrimary<>> primaries;
  for (const SharedSetting& setting : floor.settings) primaries.emplace_back(setting);
  return imaging<AreaPrimary<>>(
      {floor.shape, floor_channels(floor), std::move(primaries), floor.streams});
}

}  // namespace

std::vector<Entry> luminaire_floor() {
  return {{{.name = "luminaire/floor",
            .summary = "An image: the irradiance of a plane under a luminaire, receiver by "
                       "receiver.",
            .description =
                "The estimator luminaire/area at each of width x height receivers on the plane of "
                "the scene's receiver, which is its middle. With `shared`, one set of points on "
                "the luminaire serves all receivers of an image, whose pixels are then correlated. "
                "Samples are counted per pixel; Lambert's formula knows every pixel's mean.",
            .parameters = floor_parameters()},
           prepare}};
}

}  // namespace assay::plugins
