#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/summary.h"
#include "harness/theta/methods.h"
#include "stats/images/image.h"

namespace assay::harness {

stats::ImageExtent extent_of(const ImageShape& shape);

/// Replicates of an image, and their comparison: replicates of another image, or a number for each
/// element.
struct ComparedImages {
  stats::ImageStack first = {};
  std::optional<stats::ImageStack> second = {};
  std::vector<double> value = {};
  std::vector<double> error = {};  ///< Empty if no number has one.

  stats::ImageReference reference() const { return {first.extent, value, error}; }
  stats::ImagePair pair() const {
    return second ? stats::ImagePair(first, *second) : stats::ImagePair(first, reference());
  }
};

/// The images of a claim, with the second's scaled. Of a paired claim the replicates are
/// differences, which are held against 0.
struct ImagePair : ComparedImages {
  explicit ImagePair(const Seen& seen);
  ImagePair(const ImagePair&) = delete;  // spans point inside
  ImagePair& operator=(const ImagePair&) = delete;

  /// The fewest replicates of a side, and the most.
  auto replicates() const {
    return std::minmax({first.images.size(), (second ? *second : first).images.size()});
  }

  /// The replicates that were subtracted in pairs.
  std::optional<stats::ImageStack> subtracted = {};

 private:
  ImageViews scaled_;  // the second side, if it is
  std::vector<float> differences_;
};

/// The images of one stack less those of another, in `texels`.
stats::ImageStack difference(const stats::ImageStack& one, const stats::ImageStack& other,
                             std::vector<float>& texels);

/// Means of replicates. The spread of these means shows how far pixels depend on each other.
ChannelMeans channel_means(const stats::ImageStack& stack);

/// Means from the sums of stats::image_channel_sums.
ChannelMeans channel_means(const std::vector<double>& sums, const stats::ImageExtent& extent);

/// Means of numbers whose errors are independent between pixels.
ChannelMeans channel_means(const stats::ImageReference& reference);

/// Makes means the unit of something else.
inline void drop_errors(ChannelMeans& means) {
  for (Constant& mean : means) mean.standard_error = 0;
}

/// By channel, standard errors of a difference that is the same everywhere.
std::vector<double> uniform_errors(const ChannelMeans& first, const ChannelMeans& second);

/// The least of the errors of channels that vary: absolute, or as a part of the channel's mean.
double least_error(std::span<const double> errors, const ChannelMeans& means, bool relative);

}  // namespace assay::harness
