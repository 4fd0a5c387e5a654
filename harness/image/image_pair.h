#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/element_sums.h"
#include "harness/theta/methods.h"
#include "stats/images/image.h"

namespace assay::harness {

stats::ImageExtent extent_of(const ImageShape& shape);

/// Replicates of an image, and their comparison: scaled replicates of another image, or a number
/// for each element. Of a paired claim the replicates are differences, which are held against 0.
template <class Real>
class ImagePair {
 public:
  /// Single precision requires in_single_precision().
  ImagePair(const Question& question, std::span<const ChannelData> data);
  ImagePair(const ImagePair&) = delete;  // spans point inside
  ImagePair& operator=(const ImagePair&) = delete;

  const stats::ImageExtent& extent() const { return extent_; }
  bool of_two() const { return second_.has_value(); }
  /// The fewest replicates of a side, and the most.
  std::size_t fewest_replicates() const {
    return std::min(first_.images.size(), (second_ ? *second_ : first_).images.size());
  }
  std::size_t most_replicates() const {
    return std::max(first_.images.size(), (second_ ? *second_ : first_).images.size());
  }
  const stats::ImageStack<Real>& first() const { return first_; }
  const stats::ImageStack<Real>& second() const { return *second_; }
  stats::ImageReference reference() const { return {extent_, value_, error_}; }
  /// The replicates that were subtracted in pairs; null if none were.
  const stats::ImageStack<Real>* subtracted() const {
    return subtracted_ ? &*subtracted_ : nullptr;
  }

  /// Calls `use` with the first stack and its comparison, and returns the result.
  template <class Use>
  auto with(const Use& use) const {
    return second_ ? use(first_, *second_) : use(first_, reference());
  }

 private:
  void subtract();

  stats::ImageExtent extent_;
  ImageViews made_[2];  // for a side that is scaled or widened
  ImageViews differences_;
  stats::ImageStack<Real> first_;
  std::optional<stats::ImageStack<Real>> second_;
  std::optional<stats::ImageStack<Real>> subtracted_;
  std::vector<double> value_;
  std::vector<double> error_;
};

/// True if both sides are pictures of files and are compared unchanged.
bool in_single_precision(const Question& question, std::span<const ChannelData> data);

/// Calls `use` with the pair in its precision, and returns the result.
template <class Use>
auto with_pair(const Question& question, std::span<const ChannelData> data, const Use& use) {
  if (in_single_precision(question, data)) return use(ImagePair<float>(question, data));
  return use(ImagePair<double>(question, data));
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
