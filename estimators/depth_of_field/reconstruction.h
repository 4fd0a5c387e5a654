#pragma once

#include "depth_of_field/allocation.h"
#include "depth_of_field/family.h"

// An image from sparse samples of it, each an average over the lens.

#include "depth_of_field/splat.h"

namespace assay::depth_of_field {

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

Information reconstruction_information();

/// The parts that a reconstruction is made with.
struct ReconstructionRules {
  PredictionRules prediction = wave_rules();
  Splats (*weights)(Splats) = normalised;
};

/// Reads the parameters of depth_of_field/reconstruction.
ReconstructionPlan read_reconstruction_plan(Parameters&, const ReconstructionRules& = {});

std::shared_ptr<const Setup> prepare_reconstruction(Parameters&, const ReconstructionRules& = {});

}  // namespace assay::depth_of_field
