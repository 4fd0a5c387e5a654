#pragma once

#include <span>
#include <vector>

#include "harness/sampling/channel_list.h"

namespace assay::harness {

/// Observed images: the numbers of each, in single precision.
using Images = std::span<const std::span<const float>>;

/// The elements of each image at these channels, in their order. Channels that stand side by side
/// are viewed, others copied.
class ImageViews {
 public:
  ImageViews() = default;
  /// The images must outlive it.
  ImageViews(Images images, const ChannelList& channels);
  /// Owns the images.
  explicit ImageViews(std::vector<std::vector<float>> images);
  ImageViews(const ImageViews&) = delete;  // views point into copies
  ImageViews& operator=(const ImageViews&) = delete;
  // Moving a vector does not move its elements.
  ImageViews(ImageViews&&) noexcept = default;
  ImageViews& operator=(ImageViews&&) noexcept = default;
  ~ImageViews() = default;

  const std::vector<std::span<const float>>& images() const { return images_; }

 private:
  std::vector<std::vector<float>> copies_;
  std::vector<std::span<const float>> images_;
};

}  // namespace assay::harness
