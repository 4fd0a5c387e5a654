#pragma once

// The two sides of a claim on images as stats takes them.

#include <optional>
#include <span>
#include <vector>

#include "harness/method.h"
#include "stats/image.h"

namespace assay::harness {

stats::ImageExtent extent_of(const ImageShape& shape);

/// Replicates of an image, and what they are held against: replicates of another, scaled, or a
/// number for each element.
class ImagePair {
 public:
  ImagePair(const Question& question, std::span<const ChannelData> data);
  ImagePair(const ImagePair&) = delete;  // spans point inside
  ImagePair& operator=(const ImagePair&) = delete;

  const stats::ImageExtent& extent() const { return extent_; }
  bool of_two() const { return second_.has_value(); }
  std::size_t replicates() const { return first_.images.size(); }
  const stats::ImageStack<double>& first() const { return first_; }
  const stats::ImageStack<double>& second() const { return *second_; }
  stats::ImageReference reference() const { return {extent_, value_, error_}; }

  /// What `use` makes of the first stack and what it is held against.
  template <class Use>
  auto with(const Use& use) const {
    return second_ ? use(first_, *second_) : use(first_, reference());
  }

 private:
  stats::ImageExtent extent_;
  stats::ImageStack<double> first_;
  ImageViews scaled_;  // of the second, where a factor is not 1
  std::optional<stats::ImageStack<double>> second_;
  std::vector<double> value_;
  std::vector<double> error_;
};

}  // namespace assay::harness
