// An image behind a thin lens.
//
// Each pixel is the mean of N lens samples (pixel.cpp). N is fixed beforehand: the same for all, or
// in proportion to a power of the variance. The variance comes from a prediction or the closed
// form. N depends on no sample that is averaged, so E of every pixel is its lens average.

#include "depth_of_field/image.h"

namespace assay::depth_of_field {

Information image_information() {
  std::vector<ParameterInformation> parameters = {scene_parameter("strip")};
  for (ParameterInformation& p : grid_parameters()) parameters.push_back(std::move(p));
  parameters.push_back({.name = "samples",
                        .type = ParameterType::count,
                        .summary = "lens samples a pixel, the mean over the image",
                        .fallback = "16",
                        .low = 1,
                        .high = 1e6});
  parameters.push_back({.name = "allocation",
                        .type = ParameterType::string,
                        .summary = "what the number of lens samples of a pixel goes with: nothing, "
                                   "the variance V, V^(2/3) or sqrt V",
                        .fallback = "variance",
                        .choices = {"uniform", "variance", "two_thirds", "deviation"}});
  parameters.push_back({.name = "prediction",
                        .type = ParameterType::string,
                        .summary = "where V is from: waves or their covariance, carried to the "
                                   "lens, or the closed form (an oracle, without rays)",
                        .fallback = "waves",
                        .choices = {"waves", "covariance", "exact"}});
  return {.name = "depth_of_field/image",
          .summary = "An image behind a thin lens, lens samples allotted by predicted variance.",
          .description =
              "A primary is an image: one camera ray through the middle of the lens for each pixel "
              "and ten for each edge that neighbours see, for the prediction (none with `uniform` "
              "or `exact`), then N lens samples at each pixel, camera rays all. The prediction "
              "carries the waves of each surface to the lens and takes their power off the axis of "
              "no variation, and for an occluder's edge that hides a part c of the lens c (1 - c) "
              "(difference of the means)^2 (Soler, Subr, Durand, Holzschuch and Sillion 2009). It "
              "sees no edge that the middle of the lens does not see, and looks along rows and "
              "columns. N = max(1, K V^exponent), rounded. Means of all pixels, and variances of "
              "one image, are exact. Channels: the pixels; diagnostic ones `worst` and `quietest`, "
              "the pixels of the largest and the least noise V / N above zero by the closed form.",
          .parameters = std::move(parameters)};
}

}  // namespace assay::depth_of_field

namespace assay::plugins {

std::vector<Entry> depth_of_field_image() {
  using namespace depth_of_field;
  return {
      {image_information(), [](Parameters& given) { return image_setup(read_image_plan(given)); }}};
}

}  // namespace assay::plugins
