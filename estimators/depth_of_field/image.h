#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "depth_of_field/pixel.h"
#include "depth_of_field/prediction.h"

namespace assay::depth_of_field {

/// How much there is to give away, and how.
struct Allocation {
  double mean_count = 0;  ///< lens samples a pixel on average, 1 or more
  double exponent = 1;    ///< counts go with the variance to this power; 0 is uniform
};

/// Counts max(1, K V^exponent rounded). K is the largest with a total of at most mean_count times
/// the number of pixels. If all V are zero there is one sample each.
///
/// Exponent 1 makes the noise V / N equal for independent lens samples. Exponent 2/3 does so for
/// jittered ones across an edge, whose error falls like N^-3/2. Exponent 1/2 makes the sum of V / N
/// least (Neyman 1934).
std::vector<std::uint64_t> lens_counts(std::span<const double> variances, const Allocation& plan);

/// An image's pixels, how many lens samples each gets, and what finding that out cost.
struct ImagePlan {
  SharedSetting setting;
  Grid grid;
  std::vector<std::uint64_t> counts;
  std::vector<bool> background;  ///< of the prediction; empty without one
  std::vector<Moments> exact;    ///< of one lens sample
  Cost overhead;                 ///< of one image, beside its lens samples
};

/// `width`, `height` and `size` of an image.
std::vector<ParameterInformation> grid_parameters();
Grid read_grid(Parameters&);

/// Reads the parameters of depth_of_field/image. Predictions follow `rules`, or what `prediction`
/// says.
ImagePlan read_image_plan(Parameters&, const PredictionRules* rules = nullptr);

/// The value of a lens sample at a pixel, and its divisor.
struct SoundShading {
  double sample(const ImagePlan& plan, std::size_t pixel, Stream& random, Cost& cost) const {
    return plan.setting->radiance(plan.grid.pixel(pixel), lens_point(random), cost);
  }
  double divisor(const ImagePlan& plan, std::size_t pixel) const {
    return static_cast<double>(plan.counts[pixel]);
  }
};

/// Which pixels have the largest noise sigma^2 / N, and the least that is not zero.
struct NoiseExtremes {
  std::size_t worst = 0;
  std::size_t quietest = 0;
};
NoiseExtremes noise_extremes(const ImagePlan& plan);

/// The channels of the pixels, without their names.
std::vector<Channel> pixel_channels(const ImagePlan& plan);

/// A pixel's channel once more, for the eye.
inline Channel repeated(Channel pixel, std::string name) {
  pixel.name = std::move(name);
  pixel.diagnostic = true;
  return pixel;
}

/// A primary is an image: the prediction's rays, and for each pixel its number of lens samples from
/// a substream of its own. The channels after the pixels, `worst` and `quietest`, repeat pixels.
template <class Shading = SoundShading>
std::shared_ptr<const Setup> image_setup(ImagePlan plan, Shading shading = {}) {
  const auto shared = std::make_shared<const ImagePlan>(std::move(plan));
  const NoiseExtremes ends = noise_extremes(*shared);
  const auto estimate = [shared, shading, ends](Stream& random, std::uint64_t primaries,
                                                std::span<double> out, Cost& cost) {
    const std::size_t pixels = shared->grid.pixels();
    for (std::size_t i = 0; i < pixels; ++i) {
      Stream mine = random.substream(static_cast<std::uint32_t>(i));
      double sum = 0;
      const std::uint64_t count = primaries * shared->counts[i];
      for (std::uint64_t k = 0; k < count; ++k) sum += shading.sample(*shared, i, mine, cost);
      out[i] = sum / (static_cast<double>(primaries) * shading.divisor(*shared, i));
    }
    out[pixels] = out[ends.worst];
    out[pixels + 1] = out[ends.quietest];
    cost.camera_rays += primaries * shared->overhead.camera_rays;
    cost.samples += primaries;
  };
  const std::vector<Channel> pixels = pixel_channels(*shared);
  return setup_of({.channels = {repeated(pixels[ends.worst], "worst"),
                                repeated(pixels[ends.quietest], "quietest")},
                   .make = estimating(estimate),
                   .samplers = lens_samplers<>(),
                   .image = ImageShape{shared->grid.width, shared->grid.height, {"radiance"}, true},
                   .elements = pixels});
}

}  // namespace assay::depth_of_field
