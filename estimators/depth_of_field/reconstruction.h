#pragma once

// Scattered samples of an image, and the image from them.

#include <cstddef>
#include <span>
#include <vector>

#include "depth_of_field/image.h"
#include "depth_of_field/pixel.h"
#include "depth_of_field/prediction.h"

namespace assay::depth_of_field {

/// A sample at the middle of a pixel; its neighbours are `spacing` pixels away.
struct ImageSample {
  std::size_t x = 0;
  std::size_t y = 0;
  std::size_t spacing = 1;
};

/// Pixels whose spacing is decided together, in tiles of this side.
inline constexpr std::size_t tile_side = 8;

/// A square grid of samples in each tile, the same spacing in all.
std::vector<ImageSample> regular_samples(const Grid& grid, std::size_t spacing);

/// Spacings 1, 2, 4 or 8: in each tile the largest that samples its highest frequency twice a
/// period (Nyquist). That is spacing x pitch <= pi / bandwidth.
std::vector<ImageSample> samples_by_bandwidth(const Grid& grid, std::span<const double> bandwidth);

/// How much of a sample a pixel gets.
struct Share {
  std::size_t sample = 0;
  double weight = 0;
};

/// Shares of one pixel as they fall: a tent of a sample's own spacing to either side, in x and in
/// y. Between samples of one spacing they are those of bilinear interpolation.
using Splats = std::vector<std::vector<Share>>;
Splats tents(const Grid& grid, std::span<const ImageSample> samples);

/// Each pixel's shares divided by their sum: what is constant stays so, where samples are dense and
/// where they are sparse.
Splats normalised(Splats splats);

/// Samples of the image, how many lens samples each gets, and what each pixel takes of them.
struct ReconstructionPlan {
  SharedSetting setting;
  Grid grid;
  std::vector<ImageSample> samples;
  std::vector<std::uint64_t> counts;
  Splats splats;
  std::vector<Moments> exact;  ///< of the pixels
  Cost overhead;

  std::size_t pixel_of(const ImageSample& s) const { return s.y * grid.width + s.x; }
  /// The expectation of each pixel less its lens average.
  std::vector<double> bias() const;
};

/// The parts that a reconstruction is made with.
struct ReconstructionRules {
  PredictionRules prediction = wave_rules();
  Splats (*weights)(Splats) = normalised;
};

/// Reads the parameters of depth_of_field/reconstruction.
ReconstructionPlan read_reconstruction_plan(Parameters&, const ReconstructionRules& = {});

std::shared_ptr<const Setup> prepare_reconstruction(Parameters&, const ReconstructionRules& = {});

}  // namespace assay::depth_of_field
