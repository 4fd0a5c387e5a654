// An image behind a thin lens from samples as dense as its predicted detail asks for.
//
// Each image sample is the mean of N lens samples at a pixel's middle, N in proportion to the
// predicted variance. Each pixel is a weighted mean of the image samples near it. The lens averages
// are unbiased. E of a pixel is the interpolant of the exact means.

#include "depth_of_field/reconstruction.h"

#include "depth_of_field/image.h"

namespace assay::depth_of_field {

namespace {

std::vector<ParameterInformation> parameters() {
  std::vector<ParameterInformation> all = {scene_parameter("portrait")};
  for (ParameterInformation& p : grid_parameters()) all.push_back(std::move(p));
  all.push_back({.name = "samples",
                 .type = ParameterType::count,
                 .summary = "lens samples an image sample, the mean over the image",
                 .fallback = "16",
                 .low = 1,
                 .high = 1e6});
  all.push_back({.name = "spacing",
                 .type = ParameterType::count,
                 .summary = "of image samples: 1, 2, 4 or 8, or 0 for what the prediction says",
                 .unit = "pixels",
                 .fallback = "0",
                 .low = 0,
                 .high = 8});
  return all;
}

}  // namespace

Information reconstruction_information() {
  return {
      .name = "depth_of_field/reconstruction",
      .summary = "An image behind a thin lens, sampled sparsely where it is blurred, and splatted.",
      .description =
          "The prediction of depth_of_field/image gives each pixel the highest frequency B that "
          "the image has there: of the waves of textures and edges those that the lens lets "
          "through, radius |W| below the first zero 3.83 of 2 J1(z) / z. Tiles of 8 x 8 pixels get "
          "samples 1, 2, 4 or 8 pixels apart, the most that leaves two a period, pi / B "
          "(Soler, Subr, Durand, Holzschuch and Sillion 2009, whose samples are scattered). Each "
          "sample is the mean of N lens samples, N = max(1, K V); each pixel the mean of samples "
          "weighted by tents as wide as their spacing, divided by the sum of weights. Channels: "
          "the pixels, with their lens averages as means, which the reconstruction approaches like "
          "spacing^2 where the image is smooth; diagnostic: `worst`, the pixel that it is farthest "
          "off from.",
      .parameters = parameters(),
      .bias = BiasClass::reconstruction};
}

}  // namespace assay::depth_of_field

namespace assay::plugins {

std::vector<Entry> depth_of_field_reconstruction() {
  using namespace depth_of_field;
  return {{reconstruction_information(),
           [](Parameters& given) { return prepare_reconstruction(given); }}};
}

}  // namespace assay::plugins
