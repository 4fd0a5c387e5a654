#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/element_sums.h"
#include "harness/theta/methods.h"
#include "stats/images/image.h"

namespace assay::harness {

stats::ImageExtent extent_of(const ImageShape& shape);

/// Replicates of an image, and their comparison: replicates of another image, or a number for each
/// element.
template <class Real>
struct ComparedImages {
  stats::ImageStack<Real> first = {};
  std::optional<stats::ImageStack<Real>> second = {};
  std::vector<double> value = {};
  std::vector<double> error = {};  ///< Empty if no number has one.

  stats::ImageReference reference() const { return {first.extent, value, error}; }
  void drop_zero_errors() {
    if (std::ranges::all_of(error, [](double each) { return each == 0; })) error.clear();
  }
  /// Calls `use` with the first stack and its comparison, and returns the result.
  template <class Use>
  auto with(const Use& use) const {
    return second ? use(first, *second) : use(first, reference());
  }
};

/// The images of a claim, with the second's scaled. Of a paired claim the replicates are
/// differences, which are held against 0.
template <class Real>
struct ImagePair : ComparedImages<Real> {
  /// Single precision requires in_single_precision().
  explicit ImagePair(const Seen& seen);
  ImagePair(const ImagePair&) = delete;  // spans point inside
  ImagePair& operator=(const ImagePair&) = delete;

  /// The fewest replicates of a side, and the most.
  auto replicates() const {
    return std::minmax(
        {this->first.images.size(), (this->second ? *this->second : this->first).images.size()});
  }

  /// The replicates that were subtracted in pairs.
  std::optional<stats::ImageStack<Real>> subtracted = {};

 private:
  ImageViews made_[2];  // for a side that is scaled or widened
  std::vector<Real> differences_;
};

/// The images of one stack less those of another, in `texels`.
template <class Real>
stats::ImageStack<Real> difference(const stats::ImageStack<Real>& one,
                                   const stats::ImageStack<Real>& other, std::vector<Real>& texels);

/// True if both sides are pictures of files and are compared unchanged.
bool in_single_precision(const Seen& seen);

/// Calls `use` with the pair in its precision, and returns the result.
template <class Use>
auto with_pair(const Seen& seen, const Use& use) {
  if (in_single_precision(seen)) return use(ImagePair<float>(seen));
  return use(ImagePair<double>(seen));
}

/// Means of replicates. The spread of these means shows how far pixels depend on each other.
template <class Real>
ChannelMeans channel_means(const stats::ImageStack<Real>& stack);

/// Means from the sums of stats::image_channel_sums.
ChannelMeans channel_means(const std::vector<double>& sums, const stats::ImageExtent& extent);

/// Means of numbers whose errors are independent between pixels.
ChannelMeans channel_means(const stats::ImageReference& reference);

/// Makes means the unit of something else.
inline void drop_errors(ChannelMeans& means) {
  for (Constant& mean : means) mean.standard_error = 0;
}

/// Standard error of a theta that is the same everywhere, in the best channel: absolute, or a part
/// of the second's mean.
double uniform_error(const ChannelMeans& first, const ChannelMeans& second, bool relative);

}  // namespace assay::harness
