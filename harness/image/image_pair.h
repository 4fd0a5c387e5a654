#pragma once

// The images of a claim, and what of them varied. Elements that never varied have no standard
// error, and rare values may be unseen.

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "harness/sampling/summary.h"
#include "harness/theta/methods.h"
#include "stats/images/image.h"

namespace assay::harness {

stats::ImageExtent extent_of(const ImageShape& shape);

/// An element that was the same in every replicate and differs from its reference, or the other
/// image's mean, by more than rounding. Unseen values may make up the difference
/// (constant_sample.h). Without a declared range they are taken to be as large as the values around
/// it, if all of these elements vary. Else they are as large as all values of the image.
struct UnseenElement {
  std::size_t element = 0;
  double sign = 0;  ///< sign of constant - reference
  double log_p = 0;
};

/// The normal z of its p-value, with the difference's sign.
double z_of(const UnseenElement& unseen);

/// The elements of an image pair that did not vary.
struct ImageConstants {
  std::vector<UnseenElement> unseen = {};  ///< They are tested by their ranges.
  std::size_t count = 0;                   ///< Elements in which nothing varied on either side.
};

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
  /// Gives elements that did not vary one value. An element did not vary if its values differ by
  /// rounding only: as its channel declares, and of drawn images also to single precision.
  ///
  /// An element that did not vary is tested in sums with its neighbours. By itself it is held
  /// against its range, in `unseen`. Constants that differ by rounding only are equal. If one of
  /// two images alone varied, its standard error tests the other's constant, provided that the
  /// other declares a range. Without a range Welch's test takes the values seen.
  ImageConstants settle(const Question& question);

  stats::ImageStack first = {};
  std::optional<stats::ImageStack> second = {};
  std::vector<double> value = {};
  std::vector<double> error = {};  ///< Empty if no number has one.
  /// The replicates that were subtracted in pairs.
  std::optional<stats::ImageStack> subtracted = {};

 private:
  ImageConstants settle_against_reference(const Question& question);
  ImageConstants settle_two(const Question& question);

  ImageViews scaled_;  // the second side, if it is
  std::vector<float> differences_;
  std::vector<std::vector<float>> settled_;  // images with a rounded element
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
