#pragma once

// The images of a claim, and what of them varied.

#include <algorithm>
#include <optional>
#include <vector>

#include "harness/sampling/summary.h"
#include "harness/theta/methods.h"
#include "stats/images/image.h"
#include "stats/images/image_constants.h"
#include "stats/images/image_moments.h"

namespace assay::harness {

stats::ImageExtent extent_of(const ImageShape& shape);

/// Replicates of an image, and their comparison: replicates of another image, scaled, or a number
/// for each element. Of a paired claim the replicates are differences, which are held against 0.
struct ImagePair {
  explicit ImagePair(const Seen& seen);
  ImagePair(const ImagePair&) = delete;  // spans point inside
  ImagePair& operator=(const ImagePair&) = delete;

  /// The fewest replicates of a side, and the most.
  auto replicates() const {
    return std::minmax({first.images.size(), (second ? *second : first).images.size()});
  }
  stats::ImageReference reference() const { return {first.extent, value, error}; }
  stats::ImagePair pair() const {
    return second ? stats::ImagePair(first, *second) : stats::ImagePair(first, reference());
  }
  /// Gives elements that did not vary one value. Their values differ by rounding only: as their
  /// channel declares, and of drawn images also to single precision.
  stats::ImageConstants settle(const Question& question);

  stats::ImageStack first = {};
  std::optional<stats::ImageStack> second = {};
  std::vector<double> value = {};
  std::vector<double> error = {};  ///< Empty if no number has one.
  /// The replicates that were subtracted in pairs.
  std::optional<stats::ImageStack> subtracted = {};

 private:
  ImageViews scaled_;  // the second side, if it is
  std::vector<float> differences_;
  stats::ChangedImages settled_;
};

}  // namespace assay::harness
